// How the error falls with the number of samples, and what must not stop or spoil a frame.
#include <gtest/gtest.h>

#include <chrono>
#include <limits>
#include <thread>

#include "support/expect_error.h"
#include "support/image_tests.h"
#include "support/transport_scene.h"

namespace lumi {
namespace {

using namespace test;

TinyScene boxScene() {
    TinyScene tiny;
    tiny.add(floorMesh(6), lambert(0.7f));
    tiny.add(boxMesh(Vec3(1)), lambert(Vec3(0.7f, 0.2f, 0.2f)), translation(Vec3(0, 0.5f, 0)));
    Light lamp;
    lamp.type = LightType::Rectangle;
    lamp.radiance = Vec3(5);
    tiny.addLight(lamp, lookAt(Vec3(1, 3, 1), Vec3(0)));
    return tiny;
}

const Camera kView = lookFrom(Vec3(2, 2, 4), Vec3(0, 0.4f, 0), 40);
constexpr Extent2 kExtent{24, 18};

Image noisy(Tracer& tracer, int spp, const PathSettings& path, uint32_t seed) {
    Signals signals;
    EXPECT_TRUE(tracer.sample(frameOf(kView, kExtent, spp, path, {Signal::Noisy}, seed), signals));
    return signals[Signal::Noisy];
}

double rmse(const Image& a, const Image& b) {
    double sum = 0;
    for (size_t i = 0; i < a.size(); ++i) sum += std::pow(double(a.data()[i]) - b.data()[i], 2);
    return std::sqrt(sum / static_cast<double>(a.size()));
}

TEST(Convergence, ErrorFallsAsOneOverRootN) {
    Tracer tracer;
    tracer.bind(boxScene().pose());
    const PathSettings path = plainPaths(2);
    const Image reference = noisy(tracer, 2048, path, 99);
    // Least squares of log error over log n.
    double sx = 0, sy = 0, sxx = 0, sxy = 0;
    const int counts[] = {1, 4, 16, 64};
    for (const int n : counts) {
        const double x = std::log2(n), y = std::log2(rmse(noisy(tracer, n, path, 7), reference));
        sx += x, sy += y, sxx += x * x, sxy += x * y;
    }
    const double slope = (4 * sxy - sx * sy) / (4 * sxx - sx * sx);
    EXPECT_NEAR(slope, -0.5, 0.04);
}

TEST(Convergence, SobolBeatsIndependentNumbers) {
    Tracer tracer;
    tracer.bind(boxScene().pose());
    PathSettings path = plainPaths(1);
    const Image reference = noisy(tracer, 2048, path, 99);
    const double independent = rmse(noisy(tracer, 64, path, 3), reference);
    path.sampler = SamplerKind::Sobol;
    EXPECT_LT(rmse(noisy(tracer, 64, path, 3), reference), 0.75 * independent);
}

TEST(Stop, InTheMiddleSaysSo) {
    Tracer tracer;
    tracer.bind(boxScene().pose());
    std::stop_source source;
    Signals signals;
    const Extent2 extent{512, 512};
    std::chrono::steady_clock::time_point asked;
    std::thread asker([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(60));
        asked = std::chrono::steady_clock::now();
        source.request_stop();
    });
    const bool whole =
        tracer.sample(frameOf(kView, extent, 512, PathSettings(), SignalSet::all()), signals, source.get_token());
    const auto done = std::chrono::steady_clock::now();
    asker.join();
    EXPECT_FALSE(whole);
    // 10 ms on a quiet machine. A machine's load is no fault of the tracer: the time is recorded, not judged.
    RecordProperty("stop_ms", std::to_string(std::chrono::duration<double, std::milli>(done - asked).count()));
    // And the tracer works on.
    EXPECT_TRUE(tracer.sample(frameOf(kView, kExtent, 1, PathSettings(), SignalSet::all()), signals));
}

TEST(Stop, BeforeTheStartTracesNothing) {
    Tracer tracer;
    tracer.bind(boxScene().pose());
    std::stop_source source;
    source.request_stop();
    Signals signals;
    EXPECT_FALSE(
        tracer.sample(frameOf(kView, kExtent, 1, PathSettings(), SignalSet::all()), signals, source.get_token()));
    EXPECT_EQ(tracer.counts().total(), 0u);
}

TEST(Oddities, EmptySceneIsSky) {
    TinyScene tiny;
    tiny.scene.environment.constant = Vec3(0.25f);
    Tracer tracer;
    tracer.bind(tiny.pose());
    Signals signals;
    ASSERT_TRUE(tracer.sample(frameOf(kView, {5, 3}, 2, PathSettings(), SignalSet::all()), signals));
    for (size_t i = 0; i < signals[Signal::Noisy].size(); ++i) EXPECT_EQ(signals[Signal::Noisy].data()[i], 0.25f);
    EXPECT_EQ(signals[Signal::Depth].at(0, 2, 1), kInfinity);
    EXPECT_EQ(signals[Signal::InverseDepth].at(0, 2, 1), 0);
    EXPECT_EQ(signals.ids(Signal::ObjectId).at(0, 2, 1), 0u);
    EXPECT_EQ(signals[Signal::Albedo].at(0, 2, 1), 1);
    EXPECT_EQ(signals[Signal::Roughness].at(0, 2, 1), 1);
}

TEST(Oddities, NoLightIsBlack) {
    TinyScene tiny;
    tiny.add(floorMesh(), lambert(1));
    Tracer tracer;
    tracer.bind(tiny.pose());
    const Image image = noisy(tracer, 2, PathSettings(), 1);
    for (size_t i = 0; i < image.size(); ++i) EXPECT_EQ(image.data()[i], 0);
}

TEST(Oddities, SpoiledVerticesAndMaterialsDoNotSpread) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    TinyScene tiny = boxScene();
    Mesh spoiled = boxMesh(Vec3(0.5f));
    spoiled.positions[0] = Vec3(nan, 0, 0);
    spoiled.positions[5] = Vec3(nan);
    for (size_t i = 0; i < spoiled.normals.size(); i += 2) spoiled.normals[i] = Vec3(nan);
    Material bad = lambert(Vec3(nan, 2, -1));
    bad.roughness = nan;
    bad.emission = Vec3(nan, 1, 1);
    tiny.add(std::move(spoiled), bad, translation(Vec3(0.8f, 0.5f, 0.8f)));
    Mesh flat = floorMesh(1);
    flat.normals.assign(flat.positions.size(), Vec3(0));
    tiny.add(std::move(flat), lambert(0.5f), translation(Vec3(-1, 0.1f, 1)));
    Tracer tracer;
    tracer.bind(tiny.pose());
    Signals signals;
    ASSERT_TRUE(tracer.sample(frameOf(kView, kExtent, 8, PathSettings(), SignalSet::all()), signals));
    for (int s = 0; s < kSignalCount; ++s) {
        const auto signal = static_cast<Signal>(s);
        const Image& image = signals[signal];
        for (size_t i = 0; i < image.size(); ++i) {
            const bool sky = signal == Signal::Depth && image.data()[i] == infinity;
            ASSERT_TRUE(sky || std::isfinite(image.data()[i])) << signalInfo(signal).name;
        }
    }
}

TEST(Oddities, InfiniteVerticesAreRefused) {
    TinyScene tiny = boxScene();
    Mesh endless = boxMesh(Vec3(0.5f));
    endless.positions[5] = Vec3(std::numeric_limits<float>::infinity());
    tiny.add(std::move(endless), lambert(0.5f));
    expectError(ErrorKind::BadInput, [&] { tiny.pose(); }, {"too far", "found inf"});
}

TEST(Oddities, ClampLimitsWhatComesAfterTheFirstSurface) {
    TinyScene tiny = boxScene();
    tiny.scene.lights[0].radiance = Vec3(500);
    Tracer tracer;
    tracer.bind(tiny.pose());
    PathSettings path = plainPaths(3);
    Signals signals;
    path.clamp = true;
    path.clampRadiance = 0.01f;
    ASSERT_TRUE(tracer.sample(frameOf(kView, kExtent, 1, path, {Signal::Indirect, Signal::Direct}), signals));
    const Image& indirect = signals[Signal::Indirect];
    // Two scatterings after the first, each clamped by itself: light and nothing else.
    for (size_t i = 0; i < indirect.size(); ++i) EXPECT_LE(indirect.data()[i], 0.0401f);
}

}  // namespace
}  // namespace lumi
