#include "reconstruct/stable/shading.h"

#include <algorithm>

namespace lumi {

void GatheringSettings::describe(ParameterVisitor& v) {
    v.number(
        "indirect-alpha", indirectAlpha,
        {.label = "Indirect alpha",
         .min = 0.01,
         .max = 1,
         .scale = Scale::Log,
         .help =
             "Weight of a sample's new path in its average of indirect light (integration factor 0.1 of sec. 6.1)"});
    v.toggle("average-direct", averageDirect,
             {.label = "Average direct light",
              .help = "Direct light and reflections, which the average of diffuse indirect light leaves out, have one "
                      "too; off: they "
                      "are those of the frame, as in the paper"});
    v.toggle("converge", converge,
             {.label = "Converge while still",
              .help = "While nothing changes a sample's light is the arithmetic mean of its paths, so that a still "
                      "view converges"});
}

void SplitObserver::bounce(const BounceBatch& batch) {
    for (size_t i = 0; i < batch.slots.size(); ++i) {
        const PathVertex& v = batch.vertices[i];
        Vec3 light = v.emitted;
        if (batch.depth == 0) {
            light += v.directDiffuse + v.directSpecular;
            diffuseShare_[batch.slots[i]] = v.diffuseShare;
        }
        direct_[batch.slots[i]] += v.throughput * light;
    }
}

void addToAverage(Vec3& average, uint16_t& count, const Vec3& value, bool still, const GatheringSettings& settings) {
    // The next path is number `count`; a moving average forgets what lies further back.
    const auto most = still ? 0xFFFF : static_cast<int>(std::clamp(1 / settings.indirectAlpha + 0.5f, 1.0f, 65535.0f));
    count = static_cast<uint16_t>(std::min(count + 1, most));
    const float weight =
        still ? 1 / static_cast<float>(count) : std::max(settings.indirectAlpha, 1 / static_cast<float>(count));
    average += (value - average) * weight;
}

}  // namespace lumi
