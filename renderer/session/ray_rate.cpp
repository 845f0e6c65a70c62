#include "session/ray_rate.h"

namespace lumi {

RayRate rayRate(const FrameOutput& frame) {
    RayRate rate;
    bool read = frame.readsSignals.empty();
    for (const auto& [instance, reads] : frame.readsSignals) {
        read = read || reads;
        if (reads) continue;
        rate.rays += frame.runRays.at(instance).total();
        rate.ms += frame.runMs.at(instance);
    }
    if (!read) return rate;
    rate.rays += frame.rays.total();
    for (const auto& [stage, ms] : frame.stagesMs)
        if (stage == "trace") rate.ms += ms;
    return rate;
}

}  // namespace lumi
