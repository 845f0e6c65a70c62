#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <thread>

namespace lumi {

/// One line on standard error that is drawn over again a few times a second while it exists, then wiped.
class ProgressLine {
public:
    /// `text` is called from a thread of its own. Nothing is drawn unless `shown`.
    ProgressLine(bool shown, std::function<std::string()> text);
    ~ProgressLine();

private:
    std::jthread thread_;
};

/// Is standard error a terminal?
bool stderrIsTerminal();

/// "1:05", "2:13:00".
std::string formatDuration(double seconds);

}  // namespace lumi
