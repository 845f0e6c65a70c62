#pragma once
#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <stop_token>
#include <thread>

#include "base/error.h"

namespace lumi {

/// Turns the first interrupt of a command into a stop request; the second ends the program at once.
class InterruptGuard {
public:
    InterruptGuard() {
        sigemptyset(&signals_);
        for (const int signal : {SIGINT, SIGTERM, kWake}) sigaddset(&signals_, signal);
        pthread_sigmask(SIG_BLOCK, &signals_, nullptr);  // before other threads begin, so that they inherit it
        thread_ = std::jthread([this](std::stop_token ends) {
            while (!ends.stop_requested()) {
                int signal = 0;
                if (sigwait(&signals_, &signal) != 0 || signal == kWake) continue;
                if (stop_.stop_requested()) _exit(static_cast<int>(ErrorKind::Interrupted));
                stop_.request_stop();
            }
        });
    }
    ~InterruptGuard() {
        thread_.request_stop();
        pthread_kill(thread_.native_handle(), kWake);
    }
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;
    std::stop_token token() const { return stop_.get_token(); }

private:
    static constexpr int kWake = SIGUSR1;  ///< ends the wait of our own thread

    sigset_t signals_;
    std::stop_source stop_;
    std::jthread thread_;
};

}  // namespace lumi
