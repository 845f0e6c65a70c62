#include "reconstruct/stable/reproject_samples.h"

#include <cmath>

#include "base/parallel.h"
#include "trace/tracer.h"

namespace lumi {
namespace {

constexpr int64_t kPixels = 1 << 12, kChunk = 1 << 14;

size_t slotOf(uint32_t target) { return target & ~ReprojectedSamples::kOccluded; }

/// Where each sample lands, and whether it was occluded.
void project(const FrameContext& context, const SampleSet& previous, ReprojectedSamples& out) {
    const CameraPose& camera = context.camera;
    const bool still = !context.changes.any();
    const auto width = static_cast<uint32_t>(camera.extent.width);
    const ScreenPlaces screen(camera);
    const auto targetOf = [&](size_t i) -> uint32_t {
        const SampleLocation& location = previous.locations[i];
        Vec2& place = out.places[i];
        if (!location.isSky() && !context.tracer.has(location.point())) return ReprojectedSamples::kNowhere;
        out.inWorld[i] = placeInWorld(context.tracer, location);
        if (still) place = previous.places[i];
        else if (float depth; !screen.find(location, out.inWorld[i], place, depth)) return ReprojectedSamples::kNowhere;
        const auto x = static_cast<uint32_t>(place.x), y = static_cast<uint32_t>(place.y);
        return (y * width + x) * subpixel::kCount + static_cast<uint32_t>(subpixel::at(place - Vec2(x, y)));
    };
    parallelRanges(previous.extent.area(), kPixels, [&](int64_t begin, int64_t end) {
        for (auto pixel = static_cast<size_t>(begin); pixel < static_cast<size_t>(end); ++pixel) {
            const uint32_t word = previous.words[pixel];
            size_t i = previous.first[pixel];
            for (uint32_t bits = subpixel::occupied(word); bits; bits &= bits - 1, ++i) {
                const uint32_t target = targetOf(i);
                const bool isOccluded = subpixel::occluded(word) & (bits & (~bits + 1));
                out.targets[i] = isOccluded && target != ReprojectedSamples::kNowhere ? target | ReprojectedSamples::kOccluded : target;
            }
        }
    }, context.stop);
}

/// Samples by the row that they land in, in their order within it: a counting sort. Returns where the rows begin.
std::vector<uint32_t> sortByRow(Extent2 extent, ReprojectedSamples& out) {
    const auto count = static_cast<int64_t>(out.targets.size());
    const int64_t chunks = (count + kChunk - 1) / kChunk;
    const auto rows = static_cast<size_t>(extent.height), perRow = static_cast<size_t>(extent.width) * subpixel::kCount;
    std::vector<uint32_t> counts(static_cast<size_t>(chunks) * rows, 0);  // of chunk and row
    parallelRanges(count, kChunk, [&](int64_t begin, int64_t end) {
        uint32_t* mine = counts.data() + static_cast<size_t>(begin / kChunk) * rows;
        for (auto i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i)
            if (out.targets[i] != ReprojectedSamples::kNowhere) ++mine[slotOf(out.targets[i]) / perRow];
    });
    std::vector<uint32_t> rowBegins(rows + 1, 0);
    uint32_t sum = 0;
    for (size_t row = 0; row < rows; ++row) {
        rowBegins[row] = sum;
        for (size_t chunk = 0; chunk < static_cast<size_t>(chunks); ++chunk) {
            const uint32_t n = counts[chunk * rows + row];
            counts[chunk * rows + row] = sum;
            sum += n;
        }
    }
    rowBegins[rows] = sum;
    out.order.resize(sum);
    parallelRanges(count, kChunk, [&](int64_t begin, int64_t end) {
        uint32_t* next = counts.data() + static_cast<size_t>(begin / kChunk) * rows;
        for (auto i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i)
            if (out.targets[i] != ReprojectedSamples::kNowhere) out.order[next[slotOf(out.targets[i]) / perRow]++] = static_cast<uint32_t>(i);
    });
    return rowBegins;
}

/// Algorithm 1 over what lands in a row, from `begin` to `end` of the order.
void storeRow(size_t width, size_t row, uint32_t begin, uint32_t end, std::vector<uint32_t>& slots, ReprojectedSamples& out) {
    uint32_t* words = out.words.data() + row * width;
    for (uint32_t k = begin; k < end; ++k) {
        const uint32_t source = out.order[k], target = out.targets[source];
        const size_t slot = slotOf(target) - row * width * subpixel::kCount;
        const bool isOccluded = target & ReprojectedSamples::kOccluded;
        if (subpixel::store(words[slot / subpixel::kCount], static_cast<int>(slot % subpixel::kCount), isOccluded)) slots[slot] = source;
    }
    uint32_t next = begin;
    for (size_t x = 0; x < width; ++x) {
        out.first[row * width + x] = next;
        for (uint32_t bits = subpixel::occupied(words[x]); bits; bits &= bits - 1)
            out.sources[next++] = slots[x * subpixel::kCount + static_cast<size_t>(std::countr_zero(bits))];
    }
}

}  // namespace

Vec3 placeInWorld(const Tracer& tracer, const SampleLocation& location) {
    return location.isSky() ? location.direction() : tracer.position(location.point());
}

ScreenPlaces::ScreenPlaces(const CameraPose& camera)
    : view_(camera.cameraFromWorld), centre_(0.5f * Vec2(camera.extent.width, camera.extent.height)), size_(2.0f * centre_),
      inverseSize_(1 / camera.pixelSize()), perspective_(camera.projection == Projection::Perspective) {}

bool ScreenPlaces::find(const SampleLocation& location, const Vec3& inWorld, Vec2& place, float& depth) const {
    const bool sky = location.isSky();
    if (sky && !perspective_) return false;  // all its pixels look the same way: nothing tells them apart
    const Vec3 seen = Vec3(view_[0]) * inWorld.x + Vec3(view_[1]) * inWorld.y + Vec3(view_[2]) * inWorld.z + Vec3(view_[3]) * (sky ? 0.0f : 1.0f);
    depth = -seen.z;
    if (!(depth > 0)) return false;
    const float scale = perspective_ ? inverseSize_ / depth : inverseSize_;
    place = Vec2(centre_.x + seen.x * scale, centre_.y - seen.y * scale);
    return place.x >= 0 && place.y >= 0 && place.x < size_.x && place.y < size_.y;
}

bool reprojectSamples(const FrameContext& context, const SampleSet& previous, ReprojectedSamples& out) {
    const Extent2 extent = context.camera.extent;
    out.places.resize(previous.size());
    out.inWorld.resize(previous.size());
    out.targets.resize(previous.size());
    project(context, previous, out);
    if (context.stop.stop_requested()) return false;
    const std::vector<uint32_t> rowBegins = sortByRow(extent, out);
    out.words.assign(static_cast<size_t>(extent.area()), 0);
    out.first.resize(static_cast<size_t>(extent.area()));
    out.sources.resize(out.order.size());
    constexpr int64_t kRows = 8;
    parallelRanges(extent.height, kRows, [&](int64_t begin, int64_t end) {
        std::vector<uint32_t> slots(static_cast<size_t>(extent.width) * subpixel::kCount);
        for (auto row = static_cast<size_t>(begin); row < static_cast<size_t>(end); ++row)
            storeRow(static_cast<size_t>(extent.width), row, rowBegins[row], rowBegins[row + 1], slots, out);
    }, context.stop);
    return !context.stop.stop_requested();
}

}  // namespace lumi
