#include "reconstruct/stable/projection_kernels.h"

#include <cstddef>

#include "reconstruct/stable/sample_set.h"

namespace lumi::LUMI_ISA {
namespace {

constexpr int kLanes = 64;

/// Samples of one round, a value a lane.
struct Lanes {
    float x[kLanes], y[kLanes], z[kLanes], w[kLanes];  ///< in the world; w: 1, or 0 for directions
    float placeX[kLanes], placeY[kLanes];
    int32_t found[kLanes];  ///< 1: in front of the camera, if that is asked
};

/// Members of `row` that loops over lanes would read again after each value they write.
struct View {
    float m[12], centreX, centreY, width, height, inverseSize;
};

template <bool Perspective>
void find(const View& v, Lanes& lanes) {
    for (int i = 0; i < kLanes; ++i) {
        const float x = lanes.x[i], y = lanes.y[i], z = lanes.z[i], w = lanes.w[i];
        const float seenX = v.m[0] * x + v.m[3] * y + v.m[6] * z + v.m[9] * w;
        const float seenY = v.m[1] * x + v.m[4] * y + v.m[7] * z + v.m[10] * w;
        const float depth = -(v.m[2] * x + v.m[5] * y + v.m[8] * z + v.m[11] * w);
        // All pixels of an orthographic camera look the same way into the sky: nothing tells them apart.
        const bool ahead = Perspective ? depth > 0 : (depth > 0) & (w > 0);
        const float scale = Perspective ? v.inverseSize / (ahead ? depth : 1.0f) : v.inverseSize;
        const float placeX = v.centreX + seenX * scale, placeY = v.centreY - seenY * scale;
        lanes.found[i] = ahead & (placeX >= 0) & (placeY >= 0) & (placeX < v.width) & (placeY < v.height) ? 1 : 0;
        lanes.placeX[i] = placeX, lanes.placeY[i] = placeY;
    }
}

/// Those of `kept`, for samples that were not evicted.
void keep(const float* kept, int count, Lanes& lanes) {
    for (int i = 0; i < kLanes; ++i) {
        const int k = i < count ? i : 0;
        lanes.placeX[i] = kept[2 * k], lanes.placeY[i] = kept[2 * k + 1];
        lanes.found[i] = lanes.x[i] == lanes.x[i] ? 1 : 0;
    }
}

/// Which sub-pixel of which pixel.
void aim(const Lanes& lanes, int32_t* columns, int32_t* lines) {
    for (int i = 0; i < kLanes; ++i) {
        const float placeX = lanes.found[i] ? lanes.placeX[i] : 0.0f, placeY = lanes.found[i] ? lanes.placeY[i] : 0.0f;
        const int32_t x = static_cast<int32_t>(placeX), y = static_cast<int32_t>(placeY);
        const int32_t subX = static_cast<int32_t>((placeX - static_cast<float>(x)) * subpixel::kSide);
        const int32_t subY = static_cast<int32_t>((placeY - static_cast<float>(y)) * subpixel::kSide);
        columns[i] = x * subpixel::kCount + subY * subpixel::kSide + subX, lines[i] = y;
    }
}

void load(const float* inWorld, const uint8_t* flags, int count, Lanes& lanes) {
    for (int i = 0; i < count; ++i) {
        lanes.x[i] = inWorld[3 * i], lanes.y[i] = inWorld[3 * i + 1], lanes.z[i] = inWorld[3 * i + 2];
        lanes.w[i] = flags[i] & SampleSet::kSky ? 0.0f : 1.0f;
    }
    for (int i = count; i < kLanes; ++i) lanes.x[i] = lanes.y[i] = lanes.z[i] = lanes.w[i] = 0;
}

void project(const ProjectionRow& row) {
    View view;
    for (int k = 0; k < 12; ++k) view.m[k] = row.view[k];
    view.centreX = row.centre[0], view.centreY = row.centre[1];
    view.width = row.size[0], view.height = row.size[1], view.inverseSize = row.inverseSize;
    const uint32_t nowhere = row.nowhere;
    Lanes lanes;
    int32_t columns[kLanes], lines[kLanes];
    for (uint32_t first = 0; first < row.count; first += kLanes) {
        const int count = static_cast<int>(row.count - first < kLanes ? row.count - first : kLanes);
        const uint8_t* flags = row.flags + first;
        load(row.inWorld + 3 * static_cast<size_t>(first), flags, count, lanes);
        if (row.kept) keep(row.kept + 2 * static_cast<size_t>(first), count, lanes);
        else row.perspective ? find<true>(view, lanes) : find<false>(view, lanes);
        aim(lanes, columns, lines);
        float* places = row.places + 2 * static_cast<size_t>(first);
        for (int i = 0; i < count; ++i) places[2 * i] = lanes.placeX[i], places[2 * i + 1] = lanes.placeY[i];
        uint32_t *targets = row.targets + first, *rows = row.rows + first;
        for (int i = 0; i < count; ++i) {
            static_assert(SampleSet::kOccluded == 1);
            targets[i] = static_cast<uint32_t>(columns[i]) | static_cast<uint32_t>(flags[i] & SampleSet::kOccluded)
                                                                 << 31;
            rows[i] = lanes.found[i] ? static_cast<uint32_t>(lines[i]) : nowhere;
        }
    }
}

}  // namespace

const ProjectionKernels& projectionTable() {
    static const ProjectionKernels table{project};
    return table;
}

}  // namespace lumi::LUMI_ISA
