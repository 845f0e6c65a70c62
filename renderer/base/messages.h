#pragma once
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace lumi {

enum class Severity { Info, Warning, Error };

struct Message {
    Severity severity = Severity::Info;
    std::string text;
    int repeats = 1;      ///< how often the same text was reported
    uint64_t serial = 0;  ///< MessageLog::serial() when it was reported last
};

/// Everything the engine wants to tell a person. The library never prints: programs read this, or set a listener.
/// Safe to call from any thread. Texts become single lines of at most 4000 bytes. One that was reported before is
/// counted, not listed again.
class MessageLog {
public:
    void info(const std::string& text) { add(Severity::Info, text); }
    void warning(const std::string& text) { add(Severity::Warning, text); }
    void error(const std::string& text) { add(Severity::Error, text); }
    void add(Severity severity, const std::string& text);

    /// In the order in which they were reported last.
    std::vector<Message> messages() const;
    /// In the order in which they were reported first.
    std::vector<std::string> warnings() const;
    /// Grows with each report, repeated ones too, and when the log is cleared.
    uint64_t serial() const;
    void clear();

    /// Called for each new text, on the thread that reports it, outside the log's lock.
    void setListener(std::function<void(const Message&)> listener);

private:
    mutable std::mutex mutex_;
    std::deque<Message> messages_;                             ///< in the order in which they were reported first
    std::unordered_map<std::string_view, Message*> known_[3];  ///< by Severity; both refer to `messages_`
    uint64_t serial_ = 0;
    std::function<void(const Message&)> listener_;
};

}  // namespace lumi
