#pragma once
#include <filesystem>
#include <stop_token>
#include <string>

#include "app/cli.h"
#include "base/messages.h"

namespace lumi {

/// Runs what is missing of a study, with a progress line; prints tables, or results.json's value with --json. Returns
/// the exit code.
int runStudyCommand(const StudyCommandOptions& options, const MachineOptions& machine, MessageLog& log,
                    std::stop_token stop);

}  // namespace lumi
