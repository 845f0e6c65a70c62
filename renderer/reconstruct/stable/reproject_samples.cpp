#include "reconstruct/stable/reproject_samples.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

#include "base/parallel.h"
#include "reconstruct/stable/projection_kernels.h"
#include "trace/tracer.h"

namespace lumi {
namespace {

constexpr int64_t kChunk = 1 << 14;  ///< samples that are counted together
constexpr size_t kRun = 1 << 10;     ///< and those that stay in the nearest cache meanwhile

/// Are surfaces where they were in the frame before?
bool standsStill(const FrameContext& context, const SampleSet& previous) {
    const Changes& changes = context.changes;
    return !changes.cut && !changes.objects && !changes.lights && previous.scene.lock() == context.scene.scene;
}

/// Where samples [begin, end) are in the world now.
void place(const Tracer& tracer, const SampleSet& previous, size_t begin, size_t end, std::vector<Vec3>& inWorld) {
    for (size_t i = begin; i < end; ++i) {
        const SampleLocation& location = previous.locations[i];
        const bool exists = location.isSky() || tracer.has(location.point());
        inWorld[i] = exists ? placeInWorld(tracer, location) : Vec3(std::numeric_limits<float>::quiet_NaN());
    }
}

/// Where each sample lands, and whether it was occluded; how many of each chunk land in each row.
void project(const FrameContext& context, const SampleSet& previous, ReprojectedSamples& out) {
    const auto rows = static_cast<size_t>(context.camera.extent.height);
    const bool still = !context.changes.any(), moved = !out.moved.empty();
    ProjectionRow all;
    ScreenPlaces(context.camera).describe(all);
    all.nowhere = static_cast<uint32_t>(rows);
    parallelRanges(
        static_cast<int64_t>(previous.size()), kChunk,
        [&](int64_t chunk, int64_t chunkEnd) {
            uint32_t* counts = out.counts.data() + static_cast<size_t>(chunk / kChunk) * (rows + 1);
            for (auto begin = static_cast<size_t>(chunk); begin < static_cast<size_t>(chunkEnd); begin += kRun) {
                const size_t end = std::min(begin + kRun, static_cast<size_t>(chunkEnd));
                if (moved) place(context.tracer, previous, begin, end, out.moved);
                ProjectionRow some = all;
                some.count = static_cast<uint32_t>(end - begin);
                some.inWorld = &(moved ? out.moved : previous.inWorld)[begin].x;
                some.flags = &previous.flags[begin];
                some.kept = still ? &previous.places[begin].x : nullptr;
                some.places = &out.places[begin].x, some.targets = &out.targets[begin], some.rows = &out.rows[begin];
                projectionKernels().project(some);
                for (size_t i = begin; i < end; ++i) ++counts[out.rows[i]];
            }
        },
        context.stop);
}

/// Samples by the row that they land in, in their order within it, and those that land nowhere last: a counting sort.
/// Returns where the rows begin.
std::vector<uint32_t> sortByRow(Extent2 extent, ReprojectedSamples& out) {
    const auto count = static_cast<int64_t>(out.targets.size());
    const auto chunks = static_cast<size_t>((count + kChunk - 1) / kChunk), rows = static_cast<size_t>(extent.height);
    std::vector<uint32_t> rowBegins(rows + 1, 0);
    uint32_t sum = 0;
    for (size_t row = 0; row <= rows; ++row) {
        rowBegins[row] = sum;
        for (size_t chunk = 0; chunk < chunks; ++chunk) sum += std::exchange(out.counts[chunk * (rows + 1) + row], sum);
    }
    resizeAnew(out.order, sum);
    parallelRanges(count, kChunk, [&](int64_t begin, int64_t end) {
        uint32_t* next = out.counts.data() + static_cast<size_t>(begin / kChunk) * (rows + 1);
        for (auto i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i)
            out.order[next[out.rows[i]]++] = static_cast<uint32_t>(i);
    });
    return rowBegins;
}

/// Occupancy of four pixels, 16 bits each.
uint64_t occupancyOf(const uint32_t* words, size_t count) {
    uint64_t bits = 0;
    for (size_t k = 0; k < count; ++k)
        bits |= static_cast<uint64_t>(subpixel::occupied(words[k])) << (subpixel::kCount * k);
    return bits;
}

/// Algorithm 1 over what lands in a row, from `begin` to `end` of the order.
void storeRow(size_t width, size_t row, uint32_t begin, uint32_t end, std::vector<uint32_t>& slots,
              ReprojectedSamples& out) {
    uint32_t *words = out.words.data() + row * width, *first = out.first.data() + row * width,
             *sources = out.sources.data();
    std::fill_n(words, width, 0u);
    for (uint32_t k = begin; k < end; ++k) {
        const uint32_t source = out.order[k], target = out.targets[source],
                       slot = target & ~ReprojectedSamples::kOccluded;
        const bool isOccluded = target & ReprojectedSamples::kOccluded;
        if (subpixel::store(words[slot / subpixel::kCount], static_cast<int>(slot % subpixel::kCount), isOccluded))
            slots[slot] = source;
    }
    // Four pixels at a time, for most have none or one: what comes next is guessed wrong less often.
    constexpr size_t kPixels = 4;
    uint32_t next = begin;
    for (size_t x = 0; x < width; x += kPixels) {
        const size_t count = std::min(kPixels, width - x);
        uint32_t before = next;
        for (size_t k = 0; k < count; ++k)
            first[x + k] = before, before += subpixel::count(subpixel::occupied(words[x + k]));
        for (uint64_t bits = occupancyOf(words + x, count); bits; bits &= bits - 1)
            sources[next++] = slots[x * subpixel::kCount + static_cast<size_t>(std::countr_zero(bits))];
    }
}

}  // namespace

Vec3 placeInWorld(const Tracer& tracer, const SampleLocation& location) {
    return location.isSky() ? location.direction() : tracer.position(location.point());
}

ScreenPlaces::ScreenPlaces(const CameraPose& camera)
    : view_(camera.cameraFromWorld),
      centre_(0.5f * Vec2(camera.extent.width, camera.extent.height)),
      size_(2.0f * centre_),
      inverseSize_(1 / camera.pixelSize()),
      perspective_(camera.projection == Projection::Perspective) {}

bool ScreenPlaces::find(const SampleLocation& location, const Vec3& inWorld, Vec2& place, float& depth) const {
    const bool sky = location.isSky();
    if (sky && !perspective_) return false;  // all its pixels look the same way: nothing tells them apart
    const Vec3 seen = Vec3(view_[0]) * inWorld.x + Vec3(view_[1]) * inWorld.y + Vec3(view_[2]) * inWorld.z +
                      Vec3(view_[3]) * (sky ? 0.0f : 1.0f);
    depth = -seen.z;
    if (!(depth > 0)) return false;
    const float scale = perspective_ ? inverseSize_ / depth : inverseSize_;
    place = Vec2(centre_.x + seen.x * scale, centre_.y - seen.y * scale);
    return place.x >= 0 && place.y >= 0 && place.x < size_.x && place.y < size_.y;
}

void ScreenPlaces::describe(ProjectionRow& row) const {
    for (int c = 0; c < 4; ++c)
        for (int k = 0; k < 3; ++k) row.view[3 * c + k] = view_[c][k];
    for (int k = 0; k < 2; ++k) row.centre[k] = centre_[k], row.size[k] = size_[k];
    row.inverseSize = inverseSize_, row.perspective = perspective_;
}

bool reprojectSamples(const FrameContext& context, const SampleSet& previous, ReprojectedSamples& out) {
    const Extent2 extent = context.camera.extent;
    resizeAnew(out.places, previous.size()), resizeAnew(out.targets, previous.size()),
        resizeAnew(out.rows, previous.size());
    resizeAnew(out.moved, standsStill(context, previous) ? 0 : previous.size());
    const auto chunks = (static_cast<int64_t>(previous.size()) + kChunk - 1) / kChunk;
    out.counts.assign(static_cast<size_t>(chunks * (extent.height + 1)), 0);
    project(context, previous, out);
    if (context.stop.stop_requested()) return false;
    const std::vector<uint32_t> rowBegins = sortByRow(extent, out);
    out.words.resize(static_cast<size_t>(extent.area())), out.first.resize(static_cast<size_t>(extent.area()));
    resizeAnew(out.sources, out.order.size());
    constexpr int64_t kRows = 8;
    parallelRanges(
        extent.height, kRows,
        [&](int64_t begin, int64_t end) {
            std::vector<uint32_t> slots(static_cast<size_t>(extent.width) * subpixel::kCount);
            for (auto row = static_cast<size_t>(begin); row < static_cast<size_t>(end); ++row)
                storeRow(static_cast<size_t>(extent.width), row, rowBegins[row], rowBegins[row + 1], slots, out);
        },
        context.stop);
    return !context.stop.stop_requested();
}

}  // namespace lumi
