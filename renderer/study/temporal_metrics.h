#pragma once
#include <string>
#include <vector>

#include "frame/signals.h"

namespace lumi {

/// Two consecutive frames of one method, with the signals of both: they hold temporalSignals().
struct TemporalInput {
    const Image& image;
    const Image& previous;
    const Signals& signals;
    const Signals& previousSignals;
    float exposureEv = 0;
};

/// A metric of a sequence. Those of consecutive frames have a value from the second frame on; lag, which has no
/// `measure`, is one number of all frames after a step in the light (LagMeter).
struct TemporalMetric {
    const char* id;
    const char* title;
    const char* definition;
    double (*measure)(const TemporalInput& input);
};

const std::vector<TemporalMetric>& temporalMetricCatalog();
/// Null for an id that is not in the catalogue.
const TemporalMetric* findTemporalMetric(const std::string& id);

/// What the metrics read: motion and depth of what is seen first.
SignalSet temporalSignals();

}  // namespace lumi
