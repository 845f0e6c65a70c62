#include "reconstruct/asvgf/gradient_samples.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "filter/combined_albedo.h"
#include "math/hash.h"
#include "math/transform.h"
#include "reconstruct/surface_points.h"
#include "trace/path_lighting.h"

namespace lumi {
namespace {

/// Points to shade, as the tracer takes them.
struct Batch {
    std::vector<SurfacePoint> points;
    std::vector<Vec3> wo;
    std::vector<RandomKey> keys;
    std::vector<RayCone> cones;

    /// Seen from `camera`, with the footprint that a camera ray has there.
    void add(const CameraPose& camera, const GradientSample& sample, const Vec3& position) {
        const Vec3 pixel = camera.project(position);
        const PathStart seen = cameraStart(camera, Vec2(pixel), Vec2(0.5f), sample.point.time);
        const float distance = glm::length(position - seen.ray.origin);
        points.push_back(sample.point);
        wo.push_back(-seen.ray.direction);
        keys.push_back(sample.key);
        cones.push_back({seen.cone.width + seen.cone.spread * distance, seen.cone.spread});
    }
};

ComponentLuminance luminanceOf(const PathLighting& lighting) {
    Vec3 direct, indirect;
    for (int c = 0; c < 3; ++c) {
        const float albedo = combinedAlbedo(storedAlbedo(lighting.albedo[c]), storedAlbedo(lighting.specularAlbedo[c]));
        direct[c] = lighting.direct[c] / albedo;
        indirect[c] = lighting.indirect[c] / albedo;
    }
    const auto finite = [](float v) { return std::isfinite(v) ? v : 0.0f; };
    return {finite(luminance(direct)), finite(luminance(indirect))};
}

/// One value a point. Empty if stopped.
std::vector<ComponentLuminance> shadeAll(const FrameContext& context, const Batch& batch) {
    if (batch.points.empty()) return {};
    PathLightingObserver lighting(batch.points.size());
    PathObserver* const observers[] = {&lighting};
    if (!context.tracer.shade(batch.points, batch.wo, batch.keys, context.sampling.path, context.sampling.seed, {},
                              observers, context.stop, batch.cones))
        return {};
    std::vector<ComponentLuminance> values(batch.points.size());
    for (size_t i = 0; i < values.size(); ++i) values[i] = luminanceOf(lighting[i]);
    return values;
}

float luminanceAt(const Image& rgb, int x, int y) {
    return luminance(Vec3(rgb.at(0, x, y), rgb.at(1, x, y), rgb.at(2, x, y)));
}

}  // namespace

std::vector<GradientSample> drawGradientSamples(const FrameContext& context, const Image& direct,
                                                const Image& indirect) {
    const Extent2 extent = context.signals.extent(), strata = strataOf(extent);
    std::vector<GradientSample> samples(static_cast<size_t>(strata.area()));
    for (int64_t i = 0; i < strata.area(); ++i) {
        const int left = static_cast<int>(i % strata.width) * kStratum,
                  top = static_cast<int>(i / strata.width) * kStratum;
        const uint32_t drawn = hashCombine(static_cast<uint32_t>(i), static_cast<uint32_t>(context.frame));
        const int x = left + static_cast<int>(drawn % 3u), y = top + static_cast<int>(drawn / 3u % 3u);
        if (x >= extent.width || y >= extent.height || context.signals.ids(Signal::ObjectId).at(0, x, y) == 0) continue;
        GradientSample& sample = samples[static_cast<size_t>(i)];
        const uint64_t first = context.sampling.firstSample;
        sample.key = {static_cast<uint32_t>(x), static_cast<uint32_t>(y), static_cast<uint32_t>(first)};
        sample.point = surfacePointAt(context, x, y);
        sample.luminance = {luminanceAt(direct, x, y), luminanceAt(indirect, x, y)};
    }
    // One sample a pixel through a pinhole is what shading it again would find.
    if (context.signals.samplesPerPixel() == 1 && context.camera.aperture == 0) return samples;
    Batch batch;
    std::vector<size_t> which;
    for (size_t i = 0; i < samples.size(); ++i) {
        if (!context.tracer.has(samples[i].point)) continue;
        which.push_back(i);
        batch.add(context.camera, samples[i], context.tracer.position(samples[i].point));
    }
    const std::vector<ComponentLuminance> values = shadeAll(context, batch);
    if (values.size() != which.size()) return {};
    for (size_t i = 0; i < which.size(); ++i) samples[which[i]].luminance = values[i];
    return samples;
}

std::vector<ReshadedSample> reshade(const FrameContext& context, const std::vector<GradientSample>& samples,
                                    bool& stopped) {
    const Extent2 extent = context.signals.extent(), strata = strataOf(extent);
    const CameraPose& camera = context.camera;
    std::vector<uint8_t> taken(static_cast<size_t>(strata.area()), 0);
    std::vector<ReshadedSample> reshaded;
    Batch batch;
    for (const GradientSample& sample : samples) {
        if (!context.tracer.has(sample.point)) continue;
        // Forward projection, and a test of visibility against the present frame's surfaces.
        const Vec3 position = context.tracer.position(sample.point), pixel = camera.project(position);
        if (!(pixel.x >= 0 && pixel.y >= 0 && pixel.x < static_cast<float>(extent.width) &&
              pixel.y < static_cast<float>(extent.height)))
            continue;
        const int x = static_cast<int>(pixel.x), y = static_cast<int>(pixel.y);
        if (context.signals.ids(Signal::ObjectId).at(0, x, y) != sample.point.instance + 1) continue;
        const float z = 1 / pixel.z;  // linear view depth
        const Image& slope = context.signals[Signal::DepthGradient];
        const float allowed = 0.02f * std::fabs(z) + std::fabs(slope.at(0, x, y)) + std::fabs(slope.at(1, x, y));
        if (!(std::fabs(context.signals[Signal::InverseDepth].at(0, x, y) - z) <= allowed)) continue;
        const auto stratum =
            static_cast<size_t>(y / kStratum) * static_cast<size_t>(strata.width) + static_cast<size_t>(x / kStratum);
        if (taken[stratum]) continue;
        taken[stratum] = 1;
        reshaded.push_back({stratum, sample.luminance, {}});
        batch.add(camera, sample, position);
    }
    const std::vector<ComponentLuminance> now = shadeAll(context, batch);
    stopped = now.size() != reshaded.size();
    for (size_t i = 0; i < now.size(); ++i) reshaded[i].now = now[i];
    return reshaded;
}

}  // namespace lumi
