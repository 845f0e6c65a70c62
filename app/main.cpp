#include <cstdio>
#include <system_error>

#include "app/bench_command.h"
#include "app/cli.h"
#include "app/commands.h"
#include "app/interrupt_guard.h"
#include "app/reference_command.h"
#include "app/study_command.h"
#include "app/view.h"
#include "app/window.h"
#include "base/error.h"
#include "reconstruct/catalog.h"

namespace lumi {
namespace {

StartOptions startOptions(const SceneOptions& options) {
    StartOptions start;
    start.scene = findScene(options.scene.empty() ? "atrium" : options.scene);
    for (const std::string& module : options.modules) findModule(module, "--module");
    for (const TypedValue& value : options.values)
        if (!start.choice.set(value.id, value.text, value.option)) start.set.push_back(value);
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
        case Command::Study: {
            InterruptGuard interrupt;
            return runStudyCommand(line.study, line.machine, log, interrupt.token());
        }
        case Command::Bench: {
            InterruptGuard interrupt;
            return runBenchCommand(line.filter, line.check, line.machine, log, interrupt.token());
        }
        case Command::Reference: {
            InterruptGuard interrupt;
            return runReference(line.reference, line.machine, log, interrupt.token());
        }
        case Command::Merge: return runMerge(line.merge, line.machine);
        case Command::Info: {
            InterruptGuard interrupt;
            return runInfo(line.scene, line.check, line.writeCameraPath, line.machine, log, interrupt.token());
        }
    }
    return 0;
}

}  // namespace
}  // namespace lumi

int main(int argc, char** argv) {
    // Where both streams go to one file or pipe, lines keep their order.
    std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);
    try {
        const int code = lumi::runCommand(lumi::parseCommandLine(argc, argv));
        lumi::requireWholeOutput();
        return code;
    } catch (const lumi::Error& error) {
        std::fprintf(stderr, "lumiscope: %s\n", error.what());
        return error.exitCode();
    } catch (const std::bad_alloc&) {
        std::fputs("lumiscope: out of memory\n", stderr);
        return static_cast<int>(lumi::ErrorKind::Resources);
    } catch (const std::system_error& error) {
        std::fprintf(stderr, "lumiscope: %s\n", error.what());
        const bool full = error.code() == std::errc::no_space_on_device;
        return static_cast<int>(full ? lumi::ErrorKind::Resources : lumi::ErrorKind::BadInput);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "lumiscope: %s\n", error.what());
        return static_cast<int>(lumi::ErrorKind::BadInput);
    }
}
