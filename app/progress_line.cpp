#include "app/progress_line.h"

#include <fmt/format.h>
#include <unistd.h>

#include <condition_variable>
#include <cstdio>
#include <mutex>

namespace lumi {

ProgressLine::ProgressLine(bool shown, std::function<std::string()> text) {
    if (!shown) return;
    thread_ = std::jthread([text = std::move(text)](std::stop_token stop) {
        std::mutex mutex;
        std::condition_variable_any wake;
        std::unique_lock lock(mutex);
        while (!wake.wait_for(lock, stop, std::chrono::milliseconds(200), [] { return false; }) &&
               !stop.stop_requested())
            std::fputs(fmt::format("\r\033[K{}", text()).c_str(), stderr);
        std::fputs("\r\033[K", stderr);
    });
}

ProgressLine::~ProgressLine() = default;

bool stderrIsTerminal() { return isatty(STDERR_FILENO) == 1; }

std::string formatDuration(double seconds) {
    const int64_t whole = static_cast<int64_t>(seconds + 0.5);
    return whole < 3600 ? fmt::format("{}:{:02}", whole / 60, whole % 60)
                        : fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

}  // namespace lumi
