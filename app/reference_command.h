#pragma once
#include <functional>
#include <stop_token>

#include "app/cli.h"
#include "base/messages.h"
#include "reference/block_tracer.h"

namespace lumi {

/// Converges one image for each frame, from the cache where it has them, and writes it; with `samples` writes the block
/// sums of that part instead. Returns the exit code; throws Error. `team` (may be null) shares the work.
int runReference(const ReferenceCommand& options, const MachineOptions& machine, MessageLog& log, std::stop_token stop,
                 BlockTeam* team = nullptr);

/// Traces for another process's runReference() of the same options: serve(tracer) for each image, until it returns
/// false.
int serveReference(const ReferenceCommand& options, const MachineOptions& machine, MessageLog& log,
                   std::stop_token stop, const std::function<bool(BlockTracer&)>& serve);

/// Adds parts up, and writes the image (.exr, .png) or a larger part.
int runMerge(const MergeCommand& options, const MachineOptions& machine);

}  // namespace lumi
