#include <signal.h>
#include <unistd.h>

#include <cstdio>
#include <thread>

#include "app/bench_command.h"
#include "app/cli.h"
#include "app/commands.h"
#include "app/view.h"
#include "app/window.h"
#include "base/error.h"
#include "reconstruct/catalog.h"

namespace lumi {
namespace {

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

StartOptions startOptions(const SceneOptions& options) {
    StartOptions start;
    start.scene = findScene(options.scene.empty() ? "atrium" : options.scene);
    for (const std::string& module : options.modules) findModule(module, "--module");
    for (const TypedValue& value : options.values) {
        if (value.id == "scene.variant") start.variant = value.text;
        else if (value.id == "scene.index") start.sceneIndex = parseSceneIndex(value);
        else start.set.push_back(value);
    }
    start.modules = options.modules;
    return start;
}

int runCommand(const CommandLine& line) {
    applyMachine(line.machine);
    MessageLog log;
    switch (line.command) {
        case Command::PrintAndExit: std::fputs(line.text.c_str(), stdout); return 0;
        case Command::Compare: return runCompare(line.compare);
        case Command::List: return runList(line.list, line.machine);
        case Command::View: {
            ViewOptions view = line.view;
            view.start = startOptions(line.scene);
            view.json = line.machine.json;
            view.quiet = line.machine.quiet;
            return runView(view);
        }
        case Command::Window: {
            WindowOptions window;
            window.start = startOptions(line.scene);
            window.uiMap = line.uiMap;
            window.captures = line.captures;
            return runWindow(window);
        }
        case Command::Render: {
            InterruptGuard interrupt;
            return runRender(line.render, line.machine, log, interrupt.token());
        }
        case Command::Bench: {
            InterruptGuard interrupt;
            return runBenchCommand(line.filter, line.machine, log, interrupt.token());
        }
        case Command::Info: {
            InterruptGuard interrupt;
            return runInfo(line.scene, line.check, line.machine, log, interrupt.token());
        }
    }
    return 0;
}

}  // namespace
}  // namespace lumi

int main(int argc, char** argv) {
    try {
        return lumi::runCommand(lumi::parseCommandLine(argc, argv));
    } catch (const lumi::Error& error) {
        std::fprintf(stderr, "lumiscope: %s\n", error.what());
        return error.exitCode();
    } catch (const std::bad_alloc&) {
        std::fputs("lumiscope: out of memory\n", stderr);
        return static_cast<int>(lumi::ErrorKind::Resources);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "lumiscope: %s\n", error.what());
        return static_cast<int>(lumi::ErrorKind::BadInput);
    }
}
