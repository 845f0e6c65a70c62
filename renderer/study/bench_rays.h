#pragma once
#include <functional>

#include "trace/ray_recorder.h"

namespace lumi {

/// Calls of a record that one measurement is about.
using CallFilter = std::function<bool(const RecordedRays::Call&)>;

RecordedRays selectCalls(const RecordedRays& record, const CallFilter& filter);

/// Traces all rays again on all threads by our own functions, call by call; returns how many hit something.
uint64_t replayCalls(const EmbreeScene& scene, const RecordedRays& record);

/// Traces all rays again on all threads, one by one in recorded order, by rtcIntersect1 and rtcOccluded1 alone: what no
/// path tracer that sends single rays can beat. Returns how many hit something.
uint64_t replayBare(const EmbreeScene& scene, const RecordedRays& record);

}  // namespace lumi
