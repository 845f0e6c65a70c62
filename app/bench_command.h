#pragma once
#include <stop_token>
#include <string>

#include "base/messages.h"

namespace lumi {

struct MachineOptions;

/// Measures what the filter leaves (study/bench.h) and prints a table, row by row as it comes, or one JSON value.
/// `check`: the exit code is 1 where a mark that was measured does not hold.
int runBenchCommand(const std::string& filter, bool check, const MachineOptions& machine, MessageLog& log,
                    std::stop_token stop);

}  // namespace lumi
