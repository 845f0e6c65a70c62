#include "reconstruct/martin2002/martin2002.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cassert>
#include <limits>
#include <numeric>
#include <set>

#include "base/memory.h"
#include "base/parallel.h"
#include "math/hash.h"
#include "reconstruct/stable/reproject_samples.h"
#include "reconstruct/stable/sample_rays.h"
#include "reconstruct/stable/verification.h"
#include "trace/tracer.h"

namespace lumi {
namespace {

constexpr uint64_t kNone = ~uint64_t{0};  ///< no sample landed there
constexpr int64_t kPixels = 1 << 12;
constexpr uint32_t kStream = 0x3a472002u;  ///< second word of the samples' keys
enum Code : uint8_t { kNew, kKept, kMoved };

}  // namespace

Martin2002Module::Martin2002Module()
    : taps_({{.name = "verdicts",
              .channels = "Y",
              .range = ValueRange{0, 2},
              .colourMap = "turbo",
              .help = "The pixel's sample: 0 new, 1 kept, 2 moved to what its ray met"},
             {.name = "age",
              .channels = "Y",
              .unit = "frames",
              .range = ValueRange{0, 64},
              .help = "Frames since the pixel's sample was new or moved"},
             {.name = "unfiltered",
              .channels = "RGB",
              .unit = "W/(m^2 sr)",
              .colourMap = "none",
              .help = "The frame before the box filter over time"}}) {}

void Martin2002Module::describe(ParameterVisitor& v) {
    v.integer("frames", frames_,
              {.label = "Frames averaged",
               .min = 1,
               .max = kMostFrames,
               .unit = "frames",
               .help = "Length of the box filter over time"});
    v.choice("average", average_,
             {.label = "Averages along",
              .options = {"screen", "scene"},
              .help = "What the box filter over time follows: the pixel, or the sample on its way over the screen"});
    scattered_.describe(v, true);
}

void Martin2002Module::resize(Extent2 extent) {
    const auto colours = static_cast<uint64_t>(average_ == Average::Scene ? 3 * frames_ : 3 + frames_ + 2) * 12;
    const uint64_t aPixel = 3 * (sizeof(SampleLocation) + sizeof(Vec2) + 12) + colours + 57;
    checkMemory("the samples of martin2002", aPixel * static_cast<uint64_t>(extent.area()));
    extent_ = extent;
    const auto pixels = [](const PixelRun& run, std::vector<uint32_t>& list) {
        for (uint32_t p = run.pixel; p < run.pixel + run.count; ++p) list.push_back(p);
    };
    order_.make(extent, pixels);
    first_.resize(static_cast<size_t>(extent.area()) + 1);
    std::iota(first_.begin(), first_.end(), 0u);
    forget();
}

void Martin2002Module::forget() {
    history_.clear();
    taps_.clear();
}

/// Each sample of the frame before to the pixel where its surface is, the closest winning; ties by the lower index, so
/// that the threads' order is no part of it.
void Martin2002Module::project(const FrameContext& context, const Kept& previous) {
    nearest_.assign(static_cast<size_t>(extent_.area()), kNone);
    places_.resize(previous.locations.size());
    const ScreenPlaces screen(context.camera);
    parallelRanges(static_cast<int64_t>(previous.locations.size()), kPixels, [&](int64_t begin, int64_t end) {
        for (auto i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i) {
            const SampleLocation& location = previous.locations[i];
            if (!location.isSky() && !context.tracer.has(location.point())) continue;
            const Vec3 inWorld = placeInWorld(context.tracer, location);
            float depth = 0;
            if (!screen.find(location, inWorld, places_[i], depth)) continue;
            if (location.isSky()) depth = std::numeric_limits<float>::max();
            const uint64_t mine = static_cast<uint64_t>(std::bit_cast<uint32_t>(depth)) << 32 | i;
            const Vec2 place = places_[i];
            const size_t p =
                static_cast<size_t>(place.y) * static_cast<size_t>(extent_.width) + static_cast<size_t>(place.x);
            std::atomic_ref<uint64_t> held(nearest_[p]);
            uint64_t seen = held.load(std::memory_order_relaxed);
            while (mine < seen && !held.compare_exchange_weak(seen, mine, std::memory_order_relaxed)) {
            }
        }
    });
}

/// The closest sample of each pixel; new ones where there is none.
void Martin2002Module::reproject(const FrameContext& context, const Kept& previous, Kept& next) {
    project(context, previous);
    const auto pixels = static_cast<size_t>(extent_.area()), width = static_cast<size_t>(extent_.width);
    next.locations.resize(pixels), next.places.resize(pixels);
    next.names.resize(pixels), next.pathsDrawn.resize(pixels), next.ages.resize(pixels);
    inWorld_.resize(pixels), codes_.resize(pixels);
    const size_t followed =
        average_ == Average::Scene ? std::min(static_cast<size_t>(frames_) - 1, previous.colours.size()) : 0;
    next.colours.resize(1 + followed);
    for (std::vector<Vec3>& colours : next.colours) colours.resize(pixels);
    parallelRanges(extent_.area(), kPixels, [&](int64_t begin, int64_t end) {
        for (auto p = static_cast<size_t>(begin); p < static_cast<size_t>(end); ++p) {
            codes_[p] = nearest_[p] == kNone ? kNew : kKept;
            if (codes_[p] == kNew) {
                next.locations[p] = {};
                next.places[p] = Vec2(p % width, p / width) + 0.5f;
                next.names[p] = hashCombine(static_cast<uint32_t>(p), static_cast<uint32_t>(context.frame));
                next.pathsDrawn[p] = next.ages[p] = 0;
                continue;
            }
            const auto i = static_cast<size_t>(nearest_[p] & 0xFFFFFFFFu);
            next.locations[p] = previous.locations[i];
            next.places[p] = places_[i];
            next.names[p] = previous.names[i], next.pathsDrawn[p] = previous.pathsDrawn[i],
            next.ages[p] = previous.ages[i] + 1;
            for (size_t k = 0; k < followed; ++k) next.colours[k + 1][p] = previous.colours[k][i];
            inWorld_[p] = placeInWorld(context.tracer, next.locations[p]);
        }
    });
}

void Martin2002Module::verifyAndShade(const FrameContext& context, Kept& next) {
    const std::span<const uint32_t> order = order_.items();
    constexpr int64_t kPaths = 1024;
    parallelRanges(
        static_cast<int64_t>(order.size()), kPaths,
        [&](int64_t begin, int64_t end) {
            verifyAndShade(context, order.subspan(static_cast<size_t>(begin), static_cast<size_t>(end - begin)), next);
        },
        context.stop);
}

void Martin2002Module::verifyAndShade(const FrameContext& context, std::span<const uint32_t> pixels, Kept& next) {
    const SampleRays sampleRays(context.camera);
    const size_t count = pixels.size();
    std::vector<PathStart> starts(count);
    std::vector<Ray> rays(count);
    std::vector<float> distances(count);
    std::vector<uint32_t> ids(count);
    std::vector<Hit> hits(count);
    for (size_t k = 0; k < count; ++k) {
        const uint32_t p = pixels[k];
        distances[k] = sampleRays.aim(next.locations[p], next.places[p], inWorld_[p], starts[k]);
        rays[k] = starts[k].ray;
        ids[k] = next.names[p];
    }
    context.tracer.closestHits(rays, hits, context.stop, true, ids);
    for (size_t k = 0; k < count; ++k) {
        const uint32_t p = pixels[k];
        SampleLocation& location = next.locations[p];
        constexpr float kEpsilon = VerificationSettings::kEpsilon;
        if (!location.isNew() &&
            findsSample(context.tracer, location, rays[k].direction, hits[k], distances[k], kEpsilon)) {
            if (!location.isSky()) hits[k] = {location.point(), distances[k]};
        } else {
            if (!location.isNew()) codes_[p] = kMoved, next.ages[p] = 0;
            location =
                hits[k].valid() ? SampleLocation::ofPoint(hits[k].point) : SampleLocation::ofSky(rays[k].direction);
        }
        starts[k].key = {next.names[p], kStream, next.pathsDrawn[p]++};
        starts[k].slot = static_cast<uint32_t>(k);
    }
    std::vector<Vec3> radiance(count);
    context.tracer.continuePaths(starts, hits, context.sampling.path, context.sampling.seed, radiance, {},
                                 context.stop);
    for (size_t k = 0; k < count; ++k) next.colours.front()[pixels[k]] = radiance[k];
}

/// The image of one sample a pixel; false if stopped.
bool Martin2002Module::reconstruct(const FrameContext& context, std::span<const Vec2> places,
                                   std::span<const Vec3> colours, Image& out) {
    if (scattered_.filter == ScatteredSettings::Filter::Gaussian)
        return reconstructScattered({extent_, first_, places, colours, {}}, scattered_, out, weights_, context.stop) >=
               0;
    out.reset(extent_, 3);
    parallelRanges(extent_.area(), 1 << 14, [&](int64_t begin, int64_t end) {
        for (int64_t p = begin; p < end; ++p)
            for (int c = 0; c < 3; ++c) out.plane(c).data[p] = colours[static_cast<size_t>(p)][c];
    });
    return true;
}

/// The box filter over time along the samples: of each its colours in the last frames, of which it may have seen fewer.
void Martin2002Module::averageSamples(const Kept& kept, std::vector<Vec3>& means) const {
    means.resize(kept.locations.size());
    parallelRanges(static_cast<int64_t>(means.size()), 1 << 14, [&](int64_t begin, int64_t end) {
        for (auto p = static_cast<size_t>(begin); p < static_cast<size_t>(end); ++p) {
            const size_t count = std::min(kept.colours.size(), static_cast<size_t>(kept.ages[p]) + 1);
            Vec3 sum(0);
            for (size_t k = 0; k < count; ++k) sum += kept.colours[k][p];
            means[p] = sum / static_cast<float>(count);
        }
    });
}

/// The box filter over time on the screen.
void Martin2002Module::averageImages(const std::vector<std::shared_ptr<const Image>>& images, Image& out) const {
    out.reset(extent_, 3);
    parallelRanges(static_cast<int64_t>(out.size()), 1 << 14, [&](int64_t begin, int64_t end) {
        for (const auto& image : images)
            for (int64_t i = begin; i < end; ++i) out.data()[i] += image->data()[i];
        for (int64_t i = begin; i < end; ++i) out.data()[i] /= static_cast<float>(images.size());
    });
}

/// Reconstruction and the box filter over time; false if stopped.
bool Martin2002Module::filter(const FrameContext& context, const Kept* previous, Kept& next, Image& out) {
    const bool onScreen = average_ == Average::Screen;
    const auto image = std::make_shared<Image>();
    {
        const auto measured = context.timer.measure("reconstruction");
        if ((onScreen || taps_.wants("unfiltered")) && !reconstruct(context, next.places, next.colours.front(), *image))
            return false;
    }
    taps_.keep("unfiltered", *image);
    const auto measured = context.timer.measure("temporal");
    next.images.clear();
    if (!onScreen) {
        averageSamples(next, means_);
        return reconstruct(context, next.places, means_, out);
    }
    next.images.push_back(image);
    if (previous)
        for (const auto& earlier : previous->images)
            if (static_cast<int>(next.images.size()) < frames_) next.images.push_back(earlier);
    averageImages(next.images, out);
    return true;
}

RunResult Martin2002Module::run(const FrameContext& context, Image& out) {
    assert(context.camera.extent == extent_);
    if (context.stop.stop_requested()) return RunResult::Stopped;
    taps_.begin(context.wantedTaps);
    const auto step = history_.begin(context.frame, context.changes.cut);
    {
        const auto measured = context.timer.measure("reprojection");
        static const Kept none;
        reproject(context, step.previous ? *step.previous : none, step.next);
    }
    {
        const auto measured = context.timer.measure("verification/shading");
        verifyAndShade(context, step.next);
        if (context.stop.stop_requested()) return RunResult::Stopped;
    }
    if (!filter(context, step.previous, step.next, out)) return RunResult::Stopped;
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
    std::set<const Image*> images;  // those that frames share count once
    const size_t samples = history_.byteCount([&](const Kept& kept) {
        for (const auto& image : kept.images) images.insert(image.get());
        return kept.bytes();
    });
    size_t bytes = samples + nearest_.size() * 8 + places_.size() * sizeof(Vec2) + inWorld_.size() * 13 +
                   order_.bytes() + taps_.bytes();
    bytes += means_.size() * sizeof(Vec3) + first_.size() * 4 + weights_.bytes();
    for (const Image* image : images) bytes += image->bytes();
    return bytes;
}

}  // namespace lumi
