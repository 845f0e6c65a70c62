#include "base/messages.h"

#include <algorithm>
#include <utility>

#include "base/message_text.h"

namespace lumi {

void MessageLog::add(Severity severity, const std::string& text) {
    std::function<void(const Message&)> listener;
    Message message{severity, messageText(text, kMostOfMessage), 1, 0};
    {
        std::lock_guard lock(mutex_);
        message.serial = ++serial_;
        auto& known = known_[static_cast<size_t>(severity)];
        if (const auto same = known.find(message.text); same != known.end()) {
            ++same->second->repeats;
            same->second->serial = message.serial;
            return;
        }
        messages_.push_back(message);
        known.emplace(messages_.back().text, &messages_.back());
        listener = listener_;
    }
    if (listener) listener(message);
}

std::vector<Message> MessageLog::messages() const {
    std::unique_lock lock(mutex_);
    std::vector<Message> latest(messages_.begin(), messages_.end());
    lock.unlock();
    std::sort(latest.begin(), latest.end(), [](const Message& a, const Message& b) { return a.serial < b.serial; });
    return latest;
}

uint64_t MessageLog::serial() const {
    std::lock_guard lock(mutex_);
    return serial_;
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
    for (auto& known : known_) known.clear();
    messages_.clear();
    ++serial_;
}

void MessageLog::setListener(std::function<void(const Message&)> listener) {
    std::lock_guard lock(mutex_);
    listener_ = std::move(listener);
}

}  // namespace lumi
