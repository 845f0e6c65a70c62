#include "reconstruct/martin2002/martin2002.h"

#include <algorithm>
#include <cassert>
#include <limits>

#include "base/parallel.h"
#include "math/hash.h"
#include "reconstruct/stable/reproject_samples.h"
#include "reconstruct/stable/tile_order.h"
#include "reconstruct/stable/verification.h"
#include "trace/tracer.h"

namespace lumi {
namespace {

constexpr float kEpsilon = 1e-4f;        ///< as VerificationSettings::epsilon
constexpr uint32_t kStream = 0x3a472002u;  ///< second word of the samples' keys
enum Code : uint8_t { kNew, kKept, kMoved };

/// Where a sample of the frame before is now.
struct Landing {
    Vec3 inWorld{0};
    Vec2 place{0};
    float depth = kInfinity;  ///< infinite: nowhere on the screen
};

std::vector<Landing> land(const FrameContext& context, const std::vector<SampleLocation>& locations) {
    std::vector<Landing> landings(locations.size());
    parallelRanges(static_cast<int64_t>(locations.size()), 1 << 12, [&](int64_t begin, int64_t end) {
        for (auto i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i) {
            const SampleLocation& location = locations[i];
            if (!location.isSky() && !context.tracer.has(location.point())) continue;
            Landing& landing = landings[i];
            landing.inWorld = placeInWorld(context.tracer, location);
            if (!placeOnScreen(context.camera, location, landing.inWorld, landing.place)) continue;
            landing.depth = location.isSky() ? std::numeric_limits<float>::max() : context.camera.project(landing.inWorld).z;
        }
    });
    return landings;
}

}  // namespace

Martin2002Module::Martin2002Module()
    : taps_({{.name = "verdicts", .channels = "Y", .rangeHigh = 2, .colourMap = "turbo", .help = "The pixel's sample: 0 new, 1 kept, 2 moved to what its ray met"},
             {.name = "age", .channels = "Y", .unit = "frames", .rangeHigh = 64, .help = "Frames since the pixel's sample was new or moved"},
             {.name = "unfiltered", .channels = "RGB", .unit = "W/(m^2 sr)", .colourMap = "none", .help = "The frame before the box filter over time"}}) {}

void Martin2002Module::describe(ParameterVisitor& v) {
    v.integer("frames", frames_, {.label = "Frames averaged", .min = 1, .max = kMostFrames, .unit = "frames", .help = "Length of the box filter over time"});
}

void Martin2002Module::resize(Extent2 extent) {
    extent_ = extent;
    forget();
}

void Martin2002Module::forget() {
    history_.clear();
    taps_.clear();
}

/// The closest sample of each pixel; new ones where there is none.
void Martin2002Module::reproject(const FrameContext& context, const Kept& previous, Kept& next) {
    const auto pixels = static_cast<size_t>(extent_.area());
    next.locations.assign(pixels, {});
    next.places.resize(pixels);
    next.names.resize(pixels), next.pathsDrawn.assign(pixels, 0), next.ages.assign(pixels, 0);
    inWorld_.assign(pixels, Vec3(0));
    codes_.assign(pixels, kNew);
    std::vector<float> nearest(pixels, kInfinity);
    const auto width = static_cast<size_t>(extent_.width);
    for (size_t p = 0; p < pixels; ++p) {
        next.places[p] = Vec2(p % width, p / width) + 0.5f;
        next.names[p] = hashCombine(static_cast<uint32_t>(p), static_cast<uint32_t>(context.frame));
    }
    const std::vector<Landing> landings = land(context, previous.locations);
    for (size_t i = 0; i < landings.size(); ++i) {
        const Landing& landing = landings[i];
        if (!(landing.depth < kInfinity)) continue;
        const size_t p = static_cast<size_t>(landing.place.y) * width + static_cast<size_t>(landing.place.x);
        if (!(landing.depth < nearest[p])) continue;
        nearest[p] = landing.depth;
        next.locations[p] = previous.locations[i];
        next.places[p] = landing.place;
        next.names[p] = previous.names[i], next.pathsDrawn[p] = previous.pathsDrawn[i], next.ages[p] = previous.ages[i] + 1;
        inWorld_[p] = landing.inWorld;
        codes_[p] = kKept;
    }
}

void Martin2002Module::verifyAndShade(const FrameContext& context, Kept& next, Image& image) {
    std::vector<uint32_t> order;
    order.reserve(next.locations.size());
    for (const PixelRun& run : tileOrder(extent_))
        for (uint32_t p = run.pixel; p < run.pixel + run.count; ++p) order.push_back(p);
    constexpr int64_t kPaths = 1024;
    parallelRanges(static_cast<int64_t>(order.size()), kPaths, [&](int64_t begin, int64_t end) {
        verifyAndShade(context, std::span(order).subspan(static_cast<size_t>(begin), static_cast<size_t>(end - begin)), next, image);
    }, context.stop);
}

void Martin2002Module::verifyAndShade(const FrameContext& context, std::span<const uint32_t> pixels, Kept& next, Image& image) {
    const CameraPose camera = pinhole(context.camera);
    const size_t count = pixels.size();
    std::vector<PathStart> starts(count);
    std::vector<Ray> rays(count);
    std::vector<float> distances(count);
    std::vector<uint32_t> ids(count);
    std::vector<Hit> hits(count);
    for (size_t k = 0; k < count; ++k) {
        const uint32_t p = pixels[k];
        starts[k] = rayToSample(camera, next.locations[p], next.places[p], inWorld_[p], distances[k]);
        rays[k] = starts[k].ray;
        ids[k] = next.names[p];
    }
    context.tracer.closestHits(rays, hits, context.stop, true, ids);
    for (size_t k = 0; k < count; ++k) {
        const uint32_t p = pixels[k];
        SampleLocation& location = next.locations[p];
        const SampleLocation met = hits[k].valid() ? SampleLocation::ofPoint(hits[k].point) : SampleLocation::ofSky(rays[k].direction);
        const bool same = met.instance == location.instance &&
                          (location.isSky() || (met.primitive == location.primitive && !context.tracer.isOnLight(hits[k].point)));
        const bool expected = same || (!met.isSky() && !location.isSky() && std::abs(hits[k].distance - distances[k]) <= kEpsilon * distances[k]);
        if (!location.isNew() && expected) {
            if (!location.isSky()) hits[k] = {location.point(), distances[k]};
        } else {
            if (!location.isNew()) codes_[p] = kMoved, next.ages[p] = 0;
            location = met;
        }
        starts[k].key = {next.names[p], kStream, next.pathsDrawn[p]++};
        starts[k].slot = static_cast<uint32_t>(k);
    }
    std::vector<Vec3> radiance(count);
    context.tracer.continuePaths(starts, hits, context.sampling.path, context.sampling.seed, radiance, {}, context.stop);
    for (size_t k = 0; k < count; ++k)
        for (int c = 0; c < 3; ++c) image.plane(c).data[pixels[k]] = radiance[k][c];
}

RunResult Martin2002Module::run(const FrameContext& context, Image& out) {
    assert(context.camera.extent == extent_);
    if (context.stop.stop_requested()) return RunResult::Stopped;
    taps_.begin(context.wantedTaps);
    const auto step = history_.begin(context.frame, context.changes.cut);
    {
        const auto measured = context.timer.measure("reprojection");
        reproject(context, step.previous ? *step.previous : Kept(), step.next);
    }
    auto image = std::make_shared<Image>(extent_, 3);
    {
        const auto measured = context.timer.measure("verification/shading");
        verifyAndShade(context, step.next, *image);
        if (context.stop.stop_requested()) return RunResult::Stopped;
    }
    const auto measured = context.timer.measure("temporal");
    step.next.images = {image};
    if (step.previous)
        for (const auto& earlier : step.previous->images)
            if (static_cast<int>(step.next.images.size()) < kMostFrames) step.next.images.push_back(earlier);
    const auto count = std::min<size_t>(static_cast<size_t>(frames_), step.next.images.size());
    out.reset(extent_, 3);
    parallelRanges(static_cast<int64_t>(out.size()), 1 << 14, [&](int64_t begin, int64_t end) {
        for (size_t n = 0; n < count; ++n)
            for (int64_t i = begin; i < end; ++i) out.data()[i] += step.next.images[n]->data()[i];
        for (int64_t i = begin; i < end; ++i) out.data()[i] /= static_cast<float>(count);
    });
    taps_.keep("unfiltered", *image);
    const auto keep = [&](const char* name, const auto& values) {
        Image* tap = taps_.target(name);
        if (!tap) return;
        tap->reset(extent_, 1);
        for (size_t p = 0; p < tap->size(); ++p) tap->data()[p] = static_cast<float>(values[p]);
    };
    keep("verdicts", codes_);
    keep("age", step.next.ages);
    history_.commit();
    taps_.commit();
    return RunResult::Completed;
}

const Image& Martin2002Module::tap(const std::string& name) const {
    const Image* found = taps_.find(name);
    return found ? *found : Module::tap(name);
}

size_t Martin2002Module::byteCount() const {
    const size_t perPixel = sizeof(SampleLocation) + sizeof(Vec2) + 12;
    return history_.byteCount([&](const Kept& kept) { return kept.locations.size() * perPixel; }) +
           (history_.empty() ? 0 : history_.current().images.size() * static_cast<size_t>(extent_.area()) * 12) + inWorld_.size() * 13 + taps_.bytes();
}

}  // namespace lumi
