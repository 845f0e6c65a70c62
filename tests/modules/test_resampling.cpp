// Methods that send samples of their own: adaptive SVGF's gradients and the blockers of axis-aligned filtering.
#include "reconstruct/aaf/occlusion.h"
#include "reconstruct/asvgf/gradient_samples.h"
#include "support/module_harness.h"
#include "support/transport_scene.h"

namespace lumi::test {
namespace {

constexpr Extent2 kExtent{48, 36};

double meanOf(const Image& image) {
    double sum = 0;
    for (size_t i = 0; i < image.size(); ++i) sum += image.data()[i];
    return sum / static_cast<double>(image.size());
}

// A sample shaded again in the same scene with the same random numbers brings the same light, to the bit.
TEST(Gradients, AreZeroWhileNothingChanges) {
    for (const int spp : {1, 2}) {
        ModuleHarness harness(kExtent, spp);
        const auto module = findModule("asvgf").make();
        module->resize(kExtent);
        for (FrameNumber frame = 0; frame < 3; ++frame) {
            harness.image(*module, frame, harness.trace(frame, 0, Jitter::PerFrame));
            if (frame == 0) continue;
            // Some land outside: their pixel's centre moves with the jitter.
            EXPECT_GT(meanOf(module->tap("gradientSample")), 0.6) << spp;
            for (const char* tap : {"directGradient", "indirectGradient", "directLoss", "indirectLoss"})
                for (int64_t i = 0; i < kExtent.area(); ++i)
                    ASSERT_NEAR(module->tap(tap).data()[i], 0, 1e-5) << tap << ' ' << spp;
        }
    }
}

// Lights at a third: the relative difference is two thirds, wherever light is.
TEST(Gradients, TellHowMuchTheLightChanged) {
    ModuleHarness harness(kExtent);
    const auto adaptive = findModule("asvgf").make(), plain = findModule("svgf").make();
    for (Module* module : {adaptive.get(), plain.get()}) {
        const auto describe = [&](ParameterVisitor& v) { module->describe(v); };
        setParameter(describe, "taa", false);
        setParameter(describe, "color-alpha", 0.1f);
        module->resize(kExtent);
    }
    for (FrameNumber frame = 0; frame < 8; ++frame) {
        const Signals signals = harness.trace(frame);
        harness.image(*adaptive, frame, signals);
        harness.image(*plain, frame, signals);
    }
    const double before = meanOf(plain->tap("directLevel5"));
    harness.dimLights(true);
    const Signals signals = harness.trace(8);
    harness.image(*adaptive, 8, signals, {.lights = true});
    harness.image(*plain, 8, signals, {.lights = true});
    int told = 0;
    const Image& loss = adaptive->tap("directLoss");
    for (size_t i = 0; i < loss.size(); ++i)
        if (loss.data()[i] > 0) {
            ASSERT_NEAR(loss.data()[i], 2.0 / 3, 2e-3);
            ++told;
        }
    EXPECT_GT(told, static_cast<int>(0.6 * static_cast<double>(loss.size())));  // the box does not fill the picture
    // alpha 0.1 leaves 0.93 of the light; alpha' = 0.7 leaves 0.53.
    EXPECT_NEAR(meanOf(plain->tap("directLevel5")) / before, 1 - 0.1 * 2 / 3, 0.03);
    EXPECT_NEAR(meanOf(adaptive->tap("directLevel5")) / before, 1 - 0.7 * 2 / 3, 0.05);
}

// A light at 3 m, a sheet at 1 m over a floor: d1/d2 - 1 = 3/2 - 1 along every ray, and a square's deviation is
// L/sqrt(12).
TEST(Occlusion, IsTheRatioOfDistances) {
    TinyScene tiny;
    tiny.add(floorMesh(20), lambert(0.8f));
    tiny.add(rectangleMesh(1.5f, 1.5f, Facing::Y), lambert(0.5f), translation({0, 1, 0}));
    Light lamp;
    lamp.type = LightType::Rectangle;
    lamp.size = Vec2(0.6f);
    lamp.radiance = Vec3(40);
    Mat4 down(1);  // lights shine along their -z
    down[1] = Vec4(0, 0, 1, 0), down[2] = Vec4(0, 1, 0, 0), down[0] = Vec4(-1, 0, 0, 0), down[3] = Vec4(0, 3, 0, 1);
    tiny.addLight(lamp, down);
    const auto posed = tiny.pose();
    Tracer tracer;
    tracer.bind(posed);
    FrameSampling sampling =
        frameOf(lookFrom({3.4f, 2.2f, 2.6f}, {0, 0, 0}), {96, 72}, 1, plainPaths(1), SignalSet::all());
    sampling.jitter = Jitter::None;
    Signals signals;
    ASSERT_TRUE(tracer.sample(sampling, signals));
    const TapSet none;
    StageTimer timer;
    Image measured, gathered;
    Emitters emitters;
    const FrameContext context{0,        signals, *posed, sampling.camera, sampling.camera, {}, none, tracer,
                               sampling, timer,   {}};
    ASSERT_TRUE(measureOcclusion(context, emitters, measured));
    int blocked = 0, lit = 0;
    for (int y = 0; y < 72; ++y)
        for (int x = 0; x < 96; ++x) {
            if (signals.ids(Signal::ObjectId).at(0, x, y) != 1) continue;  // the floor
            const float size = measured.at(2, x, y);
            ASSERT_NEAR(size, size > 0 ? 0.6 / std::sqrt(12.0) : 0.0, 0.02);
            if (measured.at(1, x, y) > 0) {
                ASSERT_NEAR(measured.at(0, x, y), 0.5, 1e-3) << x << ' ' << y;
                ASSERT_EQ(signals[Signal::Visibility].at(0, x, y), 0);
                ++blocked;
            } else {
                ++lit;
            }
        }
    EXPECT_GT(blocked, 100);
    EXPECT_GT(lit, 1000);
    gatherOcclusion(signals, 3, measured, gathered);
    int reached = 0;
    for (int64_t i = 0; i < measured.extent().area(); ++i) reached += gathered.plane(1).data[i] > 0;
    EXPECT_GT(reached, blocked);
}

}  // namespace
}  // namespace lumi::test
