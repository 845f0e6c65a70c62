#include "study/temporal_metrics.h"

#include "measure/temporal.h"

namespace lumi {
namespace {

TemporalPair pairOf(const TemporalInput& input) {
    TemporalPair pair{input.image, input.previous};
    pair.exposureEv = input.exposureEv;
    if (!input.geometry || !input.previousGeometry) return pair;
    pair.motion = &(*input.geometry)[Signal::Motion];
    pair.depth = &(*input.geometry)[Signal::Depth];
    pair.previousDepth = &(*input.previousGeometry)[Signal::Depth];
    return pair;
}

double (*measureOf(const std::string& id))(const TemporalInput&) {
    if (id == "temporal") return [](const TemporalInput& input) { return measureTemporal(pairOf(input), false).value; };
    if (id == "temporal_reprojected")
        return [](const TemporalInput& input) { return measureReprojectedTemporal(pairOf(input), false).value; };
    return nullptr;
}

}  // namespace

const std::vector<TemporalMetric>& temporalMetricCatalog() {
    static const std::vector<TemporalMetric> catalog = [] {
        std::vector<TemporalMetric> list;
        for (const SequenceMetric& metric : sequenceMetricCatalog())
            list.push_back({metric.id, metric.title, metric.definition, measureOf(metric.id),
                            metric.id == std::string("temporal_reprojected")});
        return list;
    }();
    return catalog;
}

const TemporalMetric* findTemporalMetric(const std::string& id) {
    for (const TemporalMetric& metric : temporalMetricCatalog())
        if (id == metric.id) return &metric;
    return nullptr;
}

SignalSet temporalSignals() { return {Signal::Motion, Signal::Depth}; }

}  // namespace lumi
