// Starts of a row of pixels, made by kernels, against camera rays made one by one.
#include "trace/camera_starts.h"

#include <gtest/gtest.h>

#include <cstring>

#include "math/hash.h"
#include "support/transport_scene.h"
#include "trace/camera_kernels.h"
#include "trace/sampler.h"

namespace lumi {
namespace {

using namespace test;

constexpr Extent2 kExtent{97, 41};
constexpr uint32_t kSeed = 5;
constexpr uint64_t kSample = 3;

FrameSampling samplingOf(SamplerKind sampler, Jitter jitter) {
    PathSettings path;
    path.sampler = sampler;
    FrameSampling sampling = frameOf(lookFrom({1, 2, 4}, {0.3f, 0, -1}, 57), kExtent, 1, path, {Signal::Noisy}, kSeed);
    sampling.jitter = jitter;
    return sampling;
}

/// The start of one pixel as it is defined.
PathStart startOf(const FrameSampling& sampling, int x, int y) {
    const RandomKey key{static_cast<uint32_t>(x), static_cast<uint32_t>(y), static_cast<uint32_t>(kSample)};
    const SampleStream stream(sampling.path.sampler, sampling.path.haltonLoop, sampling.seed, key);
    Vec2 within(0.5f);
    if (sampling.jitter == Jitter::PerPixel) within = stream.get2(dimension::kPixel);
    if (sampling.jitter == Jitter::PerFrame) within += frameJitter(kSample, sampling.seed);
    const Vec2 lens = sampling.camera.aperture > 0 ? stream.get2(dimension::kLens) : Vec2(0.5f);
    const float time = sampling.timeOf(x, y, kSample);
    PathStart start = cameraStart(sampling.cameraAt(time), Vec2(x, y) + within, lens, time);
    start.key = key;
    start.slot = static_cast<uint32_t>(y * kExtent.width + x);
    return start;
}

void expectSame(const FrameSampling& sampling, Pixel leftTop, Pixel rightBottom) {
    std::vector<PathStart> starts(7);  // of an earlier call
    makeStarts(sampling, leftTop, rightBottom, kSample, starts);
    const int width = rightBottom.x - leftTop.x;
    ASSERT_EQ(starts.size(), static_cast<size_t>(width * (rightBottom.y - leftTop.y)));
    for (size_t i = 0; i < starts.size(); ++i) {
        const int x = leftTop.x + static_cast<int>(i) % width, y = leftTop.y + static_cast<int>(i) / width;
        const PathStart expected = startOf(sampling, x, y);
        SCOPED_TRACE(testing::Message() << x << ", " << y);
        ASSERT_LT(glm::distance(starts[i].ray.origin, expected.ray.origin), 1e-6f);
        ASSERT_LT(glm::distance(starts[i].ray.direction, expected.ray.direction), 1e-6f);
        ASSERT_NEAR(starts[i].cone.spread, expected.cone.spread, 1e-5f * expected.cone.spread);
        EXPECT_EQ(starts[i].cone.width, expected.cone.width);
        EXPECT_EQ(starts[i].ray.tmin, expected.ray.tmin);
        EXPECT_EQ(starts[i].ray.tmax, expected.ray.tmax);
        EXPECT_EQ(starts[i].ray.time, expected.ray.time);
        EXPECT_TRUE(starts[i].ray.fromCamera);
        EXPECT_EQ(starts[i].key.x, expected.key.x);
        EXPECT_EQ(starts[i].key.y, expected.key.y);
        EXPECT_EQ(starts[i].key.sample, expected.key.sample);
        EXPECT_EQ(starts[i].slot, expected.slot);
    }
}

/// Tiles of one pixel, of less and more than a vector, of the most, at the image's edges.
void expectSameTiles(const FrameSampling& sampling) {
    expectSame(sampling, {0, 0}, {1, 1});
    expectSame(sampling, {3, 2}, {20, 9});
    expectSame(sampling, {33, 0}, {33 + kMostInStartRow, 2});
    expectSame(sampling, {96, 40}, {97, 41});
}

}  // namespace

TEST(CameraStarts, ArePinholeRaysOfTheirPixels) {
    for (const SamplerKind sampler : {SamplerKind::Independent, SamplerKind::Halton, SamplerKind::Sobol})
        for (const Jitter jitter : {Jitter::None, Jitter::PerFrame, Jitter::PerPixel})
            expectSameTiles(samplingOf(sampler, jitter));
}

TEST(CameraStarts, AreRaysOfLensesShuttersAndOrthographicCameras) {
    for (const SamplerKind sampler : {SamplerKind::Halton, SamplerKind::Sobol}) {
        FrameSampling lens = samplingOf(sampler, Jitter::PerPixel);
        lens.camera.aperture = 0.2f, lens.camera.focus = 3;
        expectSameTiles(lens);
        lens.camera.blades = 5, lens.camera.bladeRotation = 0.4f;
        expectSameTiles(lens);
        FrameSampling open = samplingOf(sampler, Jitter::PerPixel);
        open.shutterOpen = true;
        expectSameTiles(open);
        CameraPose later = open.camera;
        later.worldFromCamera = translation(Vec3(0.5f, 0.1f, 0)) * later.worldFromCamera;
        open.cameraTrack = {open.camera, later};
        expectSameTiles(open);
        FrameSampling flat = samplingOf(sampler, Jitter::PerPixel);
        flat.camera.projection = Projection::Orthographic, flat.camera.halfHeight = 2;
        expectSameTiles(flat);
    }
}

TEST(CameraStarts, SameBytesOnEveryInstructionSet) {
    PinholeView view{{0.8f, 0, -0.6f}, {0, 1, 0}, {0.6f, 0, 0.8f}, 48.5f, 20.5f, 0.013f};
    constexpr int kCount = 61;
    struct Directions {
        float x[kCount], y[kCount], z[kCount], spread[kCount];
    };
    float x[kCount], y[kCount];
    for (uint32_t i = 0; i < kCount; ++i)
        x[i] = 97 * unitFloat(hashCombine(1, i)), y[i] = 41 * unitFloat(hashCombine(2, i));
    const auto run = [&](const CameraKernels& kernels) {
        Directions d{};
        kernels.pinhole(view, x, y, kCount, d.x, d.y, d.z, d.spread);
        return d;
    };
    const Directions expected = run(baseline::cameraTable());
    EXPECT_NE(expected.x[0], expected.x[kCount - 1]);
    const auto check = [&](const CameraKernels& kernels) {
        const Directions found = run(kernels);
        EXPECT_EQ(std::memcmp(&found, &expected, sizeof found), 0);
    };
    if (detectIsa() >= Isa::V3) check(v3::cameraTable());
    if (detectIsa() >= Isa::V4) check(v4::cameraTable());
}

}  // namespace lumi
