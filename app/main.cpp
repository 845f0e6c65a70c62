#include <signal.h>
#include <unistd.h>

#include <cstdio>
#include <thread>

#include "app/cli.h"
#include "app/commands.h"
#include "app/view.h"
#include "app/window.h"
#include "base/error.h"

namespace lumi {
namespace {

/// Turns the first interrupt of a command into a stop request; the second ends the program at once.
class InterruptGuard {
public:
    InterruptGuard() {
        sigemptyset(&signals_);
        sigaddset(&signals_, SIGINT);
        sigaddset(&signals_, SIGTERM);
        pthread_sigmask(SIG_BLOCK, &signals_, nullptr);  // before other threads begin, so that they inherit it
        thread_ = std::jthread([this](std::stop_token ends) {
            const timespec pause{0, 100'000'000};
            while (!ends.stop_requested()) {
                if (sigtimedwait(&signals_, nullptr, &pause) < 0) continue;
                if (stop_.stop_requested()) _exit(static_cast<int>(ErrorKind::Interrupted));
                stop_.request_stop();
            }
        });
    }
    std::stop_token token() const { return stop_.get_token(); }

private:
    sigset_t signals_;
    std::stop_source stop_;
    std::jthread thread_;
};

StartOptions startOptions(const SceneOptions& options) {
    StartOptions start;
    start.scene = findScene(options.scene.empty() ? "atrium" : options.scene);
    for (const auto& [id, text, option] : options.values) {
        if (id == "scene.variant") start.variant = text;
        else if (id == "scene.index") start.sceneIndex = std::atoi(text.c_str());
        else start.set.emplace_back(id, text);
    }
    start.modules = options.modules;
    return start;
}

int runCommand(const CommandLine& line) {
    applyMachine(line.machine);
    MessageLog log;
    switch (line.command) {
        case Command::PrintAndExit: std::fputs(line.text.c_str(), stdout); return 0;
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
        case Command::Info: {
            InterruptGuard interrupt;
            return runInfo(line.scene, line.machine, log, interrupt.token());
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
