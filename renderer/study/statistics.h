#pragma once
#include <functional>
#include <map>
#include <string>

#include "session/frame_engine.h"
#include "study/plan.h"

namespace lumi {

/// Buffers that a method's statistics are of: those that its module has.
TapSet statisticTaps(const Study& study, const StudyEntry& entry);

/// The reduction of a buffer's channel over its finite pixels; NaN if there is none. Throws Error(BadInput) for a
/// channel that the buffer does not have.
double reduced(const StudyStatistic& statistic, const Image& tap, const std::string& channels);

/// Statistics of one method's frame, by name: what it has no buffer or value for is left out. `against` gives a metric
/// against a reference of so many samples.
std::map<std::string, double> frameStatistics(const Study& study, const StudyEntry& entry, const std::string& instance,
                                              const FrameOutput& frame,
                                              const std::function<double(const std::string& metric, int spp)>& against);

}  // namespace lumi
