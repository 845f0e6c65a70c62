#include "reconstruct/stable/shading.h"

#include <algorithm>
#include <atomic>

#include "base/parallel.h"
#include "reconstruct/stable/verification.h"
#include "trace/tracer.h"

namespace lumi {
namespace {

constexpr int64_t kPaths = 1024;
constexpr uint32_t kStream = 0x57ab1e00u;  ///< second word of the samples' keys

std::span<const uint32_t> listVisible(SampleFrame& frame, const SampleSet& set) {
    return frame.list.make(set.extent, [&](const PixelRun& run, std::vector<uint32_t>& list) {
        for (uint32_t i = set.first[run.pixel]; i < set.first[run.pixel + run.count]; ++i)
            if (!frame.hidden[i]) list.push_back(i);
    });
}

/// Samples whose light is no more begin anew, those that are hidden when they are next shaded.
void restartLight(const GatheringState& state, const SampleFrame& frame, SampleSet& set) {
    if (!state.restart && !state.lightsMoved) return;
    for (size_t i = 0; i < set.size(); ++i)
        if (state.restart || frame.hidden[i]) set.lights[i].indirectCount = set.lights[i].directCount = 0;
}

/// One stretch of the list; false if stopped.
bool shadeRange(const FrameContext& context, std::span<const uint32_t> list, const GatheringSettings& settings,
                const GatheringState& state, SampleFrame& frame, SampleSet& set) {
    const CameraPose camera = pinhole(context.camera);
    std::vector<PathStart> starts(list.size());
    std::vector<Hit> hits(list.size());
    for (size_t k = 0; k < list.size(); ++k) {
        const uint32_t i = list[k];
        starts[k] = rayToSample(camera, set.locations[i], set.places[i], frame.inWorld[i], hits[k].distance);
        if (!set.locations[i].isSky()) hits[k].point = set.locations[i].point();
        starts[k].key = {set.lights[i].name, kStream, set.lights[i].pathsDrawn++};
        starts[k].slot = static_cast<uint32_t>(k);
    }
    std::vector<Vec3> direct(list.size(), Vec3(0)), diffuseShare(list.size(), Vec3(0)), radiance(list.size());
    SplitObserver observer(direct, diffuseShare);
    PathObserver* const observers[] = {&observer};
    // At depth 1 all light is direct.
    const bool split = context.sampling.path.maxDepth > 1;
    if (!context.tracer.continuePaths(starts, hits, context.sampling.path, context.sampling.seed, radiance,
                                      split ? std::span<PathObserver* const>(observers) : std::span<PathObserver* const>(), context.stop))
        return false;
    for (size_t k = 0; k < list.size(); ++k) {
        const Vec3 indirect = split ? glm::max(radiance[k] - direct[k], Vec3(0)) : Vec3(0);
        const Vec3 averaged = indirect * diffuseShare[k];
        SampleLight& light = set.lights[list[k]];
        gather(light, radiance[k] - averaged, averaged, settings.converge && state.still, settings);
        frame.colours[list[k]] = light.radiance();
    }
    return true;
}

}  // namespace

void GatheringSettings::describe(ParameterVisitor& v) {
    v.number("indirect-alpha", indirectAlpha,
             {.label = "Indirect alpha",
              .min = 0.01,
              .max = 1,
              .scale = Scale::Log,
              .help = "Weight of a sample's new path in its average of indirect light (integration factor 0.1 of sec. 6.1)"});
    v.toggle("average-direct", averageDirect,
             {.label = "Average direct light",
              .help = "Direct light and reflections, which the average of diffuse indirect light leaves out, have one too; off: they "
                      "are those of the frame, as in the paper"});
    v.toggle("converge", converge,
             {.label = "Converge while still",
              .help = "While nothing changes a sample's light is the arithmetic mean of its paths, so that a still view converges"});
}

bool shadeSamples(const FrameContext& context, const GatheringSettings& settings, const GatheringState& state, SampleFrame& frame,
                  SampleSet& set) {
    restartLight(state, frame, set);
    const std::span<const uint32_t> list = listVisible(frame, set);
    std::atomic<bool> whole{true};
    parallelRanges(static_cast<int64_t>(list.size()), kPaths, [&](int64_t begin, int64_t end) {
        if (!shadeRange(context, list.subspan(static_cast<size_t>(begin), static_cast<size_t>(end - begin)), settings, state, frame, set))
            whole = false;
    }, context.stop);
    return whole && !context.stop.stop_requested();
}

void SplitObserver::bounce(const BounceBatch& batch) {
    for (size_t i = 0; i < batch.slots.size(); ++i) {
        const PathVertex& v = batch.vertices[i];
        Vec3 light = v.emitted;
        if (batch.depth == 0) {
            light += v.directDiffuse + v.directSpecular;
            for (int c = 0; c < 3; ++c)
                diffuseShare_[batch.slots[i]][c] = v.weight[c] > 0 ? std::clamp(v.diffuseShare[c] / v.weight[c], 0.0f, 1.0f) : 0;
        }
        direct_[batch.slots[i]] += v.throughput * light;
    }
}

void gather(SampleLight& light, const Vec3& direct, const Vec3& indirect, bool still, const GatheringSettings& settings) {
    const auto most = static_cast<uint16_t>(std::clamp(1 / settings.indirectAlpha + 0.5f, 1.0f, 65535.0f));
    // The next path is number `count`; a moving average forgets what lies further back.
    const auto average = [&](Vec3& mean, uint16_t& count, const Vec3& value) {
        count = still ? static_cast<uint16_t>(std::min(count + 1, 0xFFFF)) : static_cast<uint16_t>(std::min<int>(count + 1, most));
        const float weight = still ? 1 / static_cast<float>(count) : std::max(settings.indirectAlpha, 1 / static_cast<float>(count));
        mean += (value - mean) * weight;
    };
    average(light.indirect, light.indirectCount, indirect);
    if (!still && !settings.averageDirect) light.directCount = 0;
    average(light.direct, light.directCount, direct);
}

}  // namespace lumi
