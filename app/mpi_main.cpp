// lumiscope-mpi: `reference`, its samples traced by all processes that mpirun starts.
#include <cstdio>
#include <exception>

#include "app/commands.h"
#include "app/interrupt_guard.h"
#include "app/reference_command.h"
#include "base/error.h"
#include "reference/mpi_team.h"

namespace lumi {
namespace {

int runLead(const CommandLine& line, MpiTeam& team, std::stop_token stop) {
    MessageLog log;
    try {
        const int code = runReference(line.reference, line.machine, log, stop, &team);
        team.end();
        return code;
    } catch (...) {
        team.end();
        throw;
    }
}

int runOther(const CommandLine& line, MpiTeam& team, std::stop_token stop) {
    MessageLog log;
    return serveReference(line.reference, line.machine, log, stop,
                          [&](BlockTracer& tracer) { return team.serve(tracer, stop); });
}

int run(int argc, char** argv, MpiTeam& team, std::stop_token stop) {
    CommandLine line;
    try {
        line = parseCommandLine(argc, argv);
        if (line.command == Command::PrintAndExit) {
            if (!team.leads()) return 0;
            std::fputs(line.text.c_str(), stdout);
            requireWholeOutput();
            return 0;
        }
        if (line.command != Command::Reference)
            throwUsage({"only `reference` runs as several processes", "",
                        "mpirun -n N lumiscope-mpi reference SCENE ...", ""});
        applyMachine(line.machine);
        if (!team.leads()) return runOther(line, team, stop);
        const int code = runLead(line, team, stop);
        requireWholeOutput();
        return code;
    } catch (const Error& error) {
        // What all processes find out alike is told once; what only another one finds ends them all.
        const bool alone = !team.leads() && line.command == Command::Reference && error.kind() != ErrorKind::Usage;
        if (team.leads() || alone) std::fprintf(stderr, "lumiscope-mpi: %s\n", error.what());
        if (alone) team.abort(error.exitCode());
        return error.exitCode();
    }
}

}  // namespace
}  // namespace lumi

int main(int argc, char** argv) {
    lumi::InterruptGuard interrupt;
    lumi::MpiTeam team(&argc, &argv);
    try {
        return lumi::run(argc, argv, team, interrupt.token());
    } catch (const std::exception& error) {
        std::fprintf(stderr, "lumiscope-mpi: %s\n", error.what());
        team.abort(static_cast<int>(lumi::ErrorKind::Resources));
    }
}
