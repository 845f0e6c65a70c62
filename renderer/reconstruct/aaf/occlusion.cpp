#include "reconstruct/aaf/occlusion.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/parallel.h"
#include "reconstruct/surface_points.h"
#include "trace/path_lighting.h"
#include "trace/tracer.h"

namespace lumi {
namespace {

constexpr int kBand = 64;  ///< rows whose shadow rays are sent together

/// Positions that one light was sampled at.
struct LightSpread {
    double count = 0;
    float size = 0;  ///< its deviation, once all are there
    glm::dvec3 sum{0}, squares{0};
    void add(const Vec3& position) {
        const glm::dvec3 p(position);
        count += 1;
        sum += p;
        squares += p * p;
    }
    /// Along one of its two dimensions, without bias; of at least two positions.
    float deviation() const {
        const glm::dvec3 mean = sum / count, variance = (squares / count - mean * mean) * (count / (count - 1));
        return static_cast<float>(std::sqrt(std::max(0.5 * (variance.x + variance.y + variance.z), 0.0)));
    }
};

struct Pixels {
    std::vector<SurfacePoint> points;
    std::vector<Vec3> wo;
    std::vector<RandomKey> keys;
    std::vector<RayCone> cones;
};

Pixels pixelsOf(const FrameContext& context, int top, int bottom) {
    const int width = context.signals.extent().width;
    const uint64_t first = context.sampling.firstSample;
    const Vec2 jitter =
        context.sampling.jitter == Jitter::PerFrame ? frameJitter(first, context.sampling.seed) : Vec2(0);
    Pixels pixels;
    for (int y = top; y < bottom; ++y)
        for (int x = 0; x < width; ++x) {
            SurfacePoint point = surfacePointAt(context, x, y);
            if (!context.tracer.has(point)) point = {};
            const PathStart start =
                cameraStart(context.camera, Vec2(x, y) + Vec2(0.5f) + jitter, Vec2(0.5f), point.time);
            const float distance = point.valid() ? glm::length(context.tracer.position(point) - start.ray.origin) : 0;
            pixels.points.push_back(point);
            pixels.wo.push_back(-start.ray.direction);
            pixels.keys.push_back({static_cast<uint32_t>(x), static_cast<uint32_t>(y), static_cast<uint32_t>(first)});
            pixels.cones.push_back({start.cone.width + start.cone.spread * distance, start.cone.spread});
        }
    return pixels;
}

/// d1/d2 - 1, or the blocker's distance from the surface where the light is infinitely far.
float slopeOf(const Tracer& tracer, const ShadowSample& sample, const Vec3& position) {
    if (!tracer.has(sample.blocker)) return 0;
    const Vec3 blocker = tracer.position(sample.blocker);
    if (sample.infinite) return glm::length(blocker - position);
    const float d1 = glm::length(sample.lightPosition - position), d2 = glm::length(sample.lightPosition - blocker);
    return std::max(d1 / std::max(d2, 1e-6f) - 1, 0.0f);
}

}  // namespace

bool measureOcclusion(const FrameContext& context, Emitters& emitters, Image& out) {
    const Extent2 extent = context.signals.extent();
    if (out.extent() != extent) out.reset(extent, 3);
    out.fill(0);
    PathSettings settings = context.sampling.path;
    settings.maxDepth = 1;
    if (settings.strategy == DirectStrategy::Bsdf) settings.strategy = DirectStrategy::Light;
    std::map<uint64_t, LightSpread> spreads;
    std::vector<const LightSpread*> sampled(static_cast<size_t>(extent.area()), nullptr);  // of each pixel's light
    for (int top = 0; top < extent.height; top += kBand) {
        const int bottom = std::min(top + kBand, extent.height);
        const Pixels pixels = pixelsOf(context, top, bottom);
        ShadowObserver shadows(pixels.points.size());
        PathObserver* const observers[] = {&shadows};
        if (!context.tracer.shade(pixels.points, pixels.wo, pixels.keys, settings, context.sampling.seed, {}, observers,
                                  context.stop, pixels.cones))
            return false;
        for (size_t i = 0; i < pixels.points.size(); ++i) {
            const ShadowSample& sample = shadows[i];
            if (sample.light < 0) continue;
            const int x = static_cast<int>(i) % extent.width, y = top + static_cast<int>(i) / extent.width;
            const uint64_t emitter = emitters.emitterOf(context.tracer, sample.light);
            LightSpread& spread = spreads[emitter];
            spread.add(sample.lightPosition);
            sampled[static_cast<size_t>(y) * static_cast<size_t>(extent.width) + static_cast<size_t>(x)] = &spread;
            if (!sample.blocked || emitters.isOn(context.tracer, sample.blocker, emitter)) continue;
            out.at(0, x, y) = slopeOf(context.tracer, sample, context.tracer.position(pixels.points[i]));
            out.at(1, x, y) = 1;
        }
    }
    for (auto& [emitter, spread] : spreads) spread.size = spread.count > 1 ? spread.deviation() : 0;
    for (size_t i = 0; i < sampled.size(); ++i) {
        if (sampled[i] && sampled[i]->count > 1) out.plane(2).data[i] = sampled[i]->size;
        else out.plane(0).data[i] = out.plane(1).data[i] = 0;
    }
    return true;
}

bool facesAlike(const Image& normal, Pixel p, Pixel q) {
    float cosine = 0;
    for (int c = 0; c < 3; ++c) cosine += normal.at(c, p.x, p.y) * normal.at(c, q.x, q.y);
    return cosine > 0.9f;
}

void gatherOcclusion(const Signals& signals, int radius, const Image& in, Image& out) {
    const Extent2 extent = in.extent();
    if (out.extent() != extent) out.reset(extent, 3);
    const Image& normal = signals[Signal::Normal];
    parallelFor(extent.height, [&](int64_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < extent.width; ++x) {
            float least = kInfinity, slope = 0;  // the least width, and the slope that it belongs to
            for (int j = std::max(y - radius, 0); j <= std::min(y + radius, extent.height - 1); ++j)
                for (int i = std::max(x - radius, 0); i <= std::min(x + radius, extent.width - 1); ++i) {
                    const float width = in.at(0, i, j) * in.at(2, i, j);
                    if (in.at(1, i, j) == 0 || !(width < least) || !facesAlike(normal, {x, y}, {i, j})) continue;
                    least = width;
                    slope = in.at(0, i, j);
                }
            const bool found = least < kInfinity;
            out.at(0, x, y) = slope;
            out.at(1, x, y) = found ? 1 : 0;
            out.at(2, x, y) = found ? least : 0;
        }
    });
}

}  // namespace lumi
