#include "trace/camera_starts.h"

#include <cassert>

#include "trace/camera_kernels.h"
#include "trace/sampler.h"
#include "trace/sampler_kernels.h"

namespace lumi {
namespace {

/// Pixels of a row, and where in them their rays pass.
struct StartRow {
    int left = 0, y = 0, count = 0;
    float x[kMostInStartRow], yWithin[kMostInStartRow];  ///< continuous pixels
};

RandomKey keyOf(const StartRow& row, int i, uint64_t sample) {
    return {static_cast<uint32_t>(row.left + i), static_cast<uint32_t>(row.y), static_cast<uint32_t>(sample)};
}

SampleStream streamOf(const FrameSampling& sampling, const RandomKey& key) {
    return SampleStream(sampling.path.sampler, sampling.path.haltonLoop, sampling.seed, key);
}

void placeInPixels(const FrameSampling& sampling, Vec2 common, uint64_t sample, StartRow& row) {
    std::fill_n(row.x, row.count, common.x);
    std::fill_n(row.yWithin, row.count, common.y);
    if (sampling.jitter == Jitter::PerPixel && sampling.path.sampler == SamplerKind::Sobol) {
        uint32_t scramble[kMostInStartRow], index[kMostInStartRow];
        uint64_t seeds[kMostInStartRow];
        for (int i = 0; i < row.count; ++i) {
            const SampleStream stream = streamOf(sampling, keyOf(row, i, sample));
            scramble[i] = stream.scramble(), index[i] = stream.index();
        }
        samplerKernels().pairs(scramble, index, row.count, dimension::kPixel >> 1, seeds, row.x, row.yWithin);
    } else if (sampling.jitter == Jitter::PerPixel) {
        for (int i = 0; i < row.count; ++i) {
            const Vec2 within = streamOf(sampling, keyOf(row, i, sample)).get2(dimension::kPixel);
            row.x[i] = within.x, row.yWithin[i] = within.y;
        }
    }
    for (int i = 0; i < row.count; ++i) {
        row.x[i] = static_cast<float>(row.left + i) + row.x[i];
        row.yWithin[i] = static_cast<float>(row.y) + row.yWithin[i];
    }
}

PinholeView viewOf(const CameraPose& camera) {
    PinholeView view;
    const Mat4& m = camera.worldFromCamera;
    for (int i = 0; i < 3; ++i) view.axisX[i] = m[0][i], view.axisY[i] = m[1][i], view.axisZ[i] = m[2][i];
    view.centreX = 0.5f * static_cast<float>(camera.extent.width);
    view.centreY = 0.5f * static_cast<float>(camera.extent.height);
    view.pixelSize = camera.pixelSize();
    return view;
}

void startPinhole(const FrameSampling& sampling, const PinholeView& view, const StartRow& row, PathStart* starts) {
    float x[kMostInStartRow], y[kMostInStartRow], z[kMostInStartRow], spread[kMostInStartRow];
    cameraKernels().pinhole(view, row.x, row.yWithin, row.count, x, y, z, spread);
    const Vec3 origin = transformPoint(sampling.camera.worldFromCamera, Vec3(0));
    for (int i = 0; i < row.count; ++i) {
        Ray& ray = starts[i].ray;
        ray.origin = origin;
        ray.direction.x = x[i], ray.direction.y = y[i], ray.direction.z = z[i];
        ray.tmin = ray.time = 0, ray.tmax = kInfinity;
        ray.fromCamera = true;
        starts[i].cone.width = 0, starts[i].cone.spread = spread[i];
    }
}

/// Lenses, shutters, cameras that move and orthographic ones: ray by ray.
PathStart startGeneral(const FrameSampling& sampling, Vec2 place, const RandomKey& key) {
    const SampleStream stream = streamOf(sampling, key);
    const Vec2 onLens = sampling.camera.aperture > 0 ? stream.get2(dimension::kLens) : Vec2(0.5f);
    const float time = sampling.shutterOpen ? stream.get1(dimension::kTime) : 0;
    return sampling.cameraTrack.empty() ? cameraStart(sampling.camera, place, onLens, time)
                                        : cameraStart(sampling.cameraAt(time), place, onLens, time);
}

}  // namespace

void makeStarts(const FrameSampling& sampling, Pixel leftTop, Pixel rightBottom, uint64_t sample,
                std::vector<PathStart>& starts) {
    assert(rightBottom.x - leftTop.x <= kMostInStartRow);
    const CameraPose& camera = sampling.camera;
    const bool pinhole = camera.projection == Projection::Perspective && !(camera.aperture > 0) &&
                         !sampling.shutterOpen && sampling.cameraTrack.empty();
    const PinholeView view = viewOf(camera);
    const Vec2 common =
        sampling.jitter == Jitter::PerFrame ? frameJitter(sample, sampling.seed) + Vec2(0.5f) : Vec2(0.5f);
    const int width = rightBottom.x - leftTop.x;
    starts.resize(static_cast<size_t>(width) * static_cast<size_t>(rightBottom.y - leftTop.y));
    StartRow row;
    row.left = leftTop.x, row.count = width;
    PathStart* first = starts.data();
    for (row.y = leftTop.y; row.y < rightBottom.y; ++row.y, first += width) {
        placeInPixels(sampling, common, sample, row);
        if (pinhole) startPinhole(sampling, view, row, first);
        for (int i = 0; i < width; ++i) {
            const RandomKey key = keyOf(row, i, sample);
            if (!pinhole) first[i] = startGeneral(sampling, {row.x[i], row.yWithin[i]}, key);
            first[i].key.x = key.x, first[i].key.y = key.y, first[i].key.sample = key.sample;
            first[i].slot = static_cast<uint32_t>(row.y * sampling.extent.width + row.left + i);
        }
    }
}

}  // namespace lumi
