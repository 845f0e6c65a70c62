#pragma once
#include <string>
#include <vector>

#include "frame/signals.h"

namespace lumi {

/// Two consecutive frames of one method, and how the points moved that the reference sees in them.
struct TemporalInput {
    const Image& image;
    const Image& previous;
    /// of the later frame, with temporalSignals(); null for metrics that follow nothing
    const Signals* geometry = nullptr;
    const Signals* previousGeometry = nullptr;
    float exposureEv = 0;
};

/// A metric of a sequence. Those of consecutive frames have a value from the second frame on; lag, which has no
/// `measure`, is one number of all frames after a step in the light (LagMeter).
struct TemporalMetric {
    const char* id;
    const char* title;
    const char* definition;
    double (*measure)(const TemporalInput& input);
    bool followsMotion = false;  ///< `geometry` is wanted
};

const std::vector<TemporalMetric>& temporalMetricCatalog();
/// Null for an id that is not in the catalogue.
const TemporalMetric* findTemporalMetric(const std::string& id);

/// What those metrics read that follow the motion of what is seen: motion and depth.
SignalSet temporalSignals();

}  // namespace lumi
