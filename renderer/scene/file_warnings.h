#pragma once
#include <mutex>
#include <string>
#include <unordered_set>

#include "base/messages.h"

namespace lumi {

/// The warnings of one file that is being loaded: the same text is listed once, and of a file that is all wrong the
/// first 200 texts are. Safe to call from any thread.
class FileWarnings {
public:
    /// `file` heads every text.
    FileWarnings(std::string file, MessageLog& log) : file_(std::move(file)), log_(log) {}

    const std::string& file() const { return file_; }
    void warn(const std::string& text) { warnWhole(file_ + ": " + text); }
    /// A text that names its file itself.
    void warnWhole(const std::string& text);
    /// One more line where texts were left out. At the end of the load.
    void tellOfMore() const;

private:
    std::string file_;
    MessageLog& log_;
    std::mutex mutex_;
    std::unordered_set<std::string> listed_;
    size_t more_ = 0;
};

}  // namespace lumi
