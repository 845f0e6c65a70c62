#include "base/messages.h"

#include <algorithm>
#include <utility>

namespace lumi {

void MessageLog::add(Severity severity, std::string text) {
    std::function<void(const Message&)> listener;
    Message message{severity, std::move(text), 1};
    {
        std::lock_guard lock(mutex_);
        const auto same = std::find_if(messages_.begin(), messages_.end(), [&](const Message& m) {
            return m.severity == severity && m.text == message.text;
        });
        if (same != messages_.end()) {
            ++same->repeats;
            return;
        }
        messages_.push_back(message);
        listener = listener_;
    }
    if (listener) listener(message);
}

std::vector<Message> MessageLog::messages() const {
    std::lock_guard lock(mutex_);
    return messages_;
}

std::vector<std::string> MessageLog::warnings() const {
    std::vector<std::string> texts;
    std::lock_guard lock(mutex_);
    for (const Message& message : messages_)
        if (message.severity == Severity::Warning) texts.push_back(message.text);
    return texts;
}

void MessageLog::clear() {
    std::lock_guard lock(mutex_);
    messages_.clear();
}

void MessageLog::setListener(std::function<void(const Message&)> listener) {
    std::lock_guard lock(mutex_);
    listener_ = std::move(listener);
}

}  // namespace lumi
