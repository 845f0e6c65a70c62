// The contract of frame/signals.h, on a frame that has every kind of surface.
#include <gtest/gtest.h>

#include <bit>

#include "support/transport_scene.h"

namespace lumi {
namespace {

using namespace test;

constexpr Extent2 kExtent{40, 30};

class SignalsContract : public testing::Test {
protected:
    void SetUp() override {
        TinyScene tiny;
        tiny.add(floorMesh(8), lambert(Vec3(0.7f, 0.005f, 0.4f)));
        tiny.add(sphereMesh(0.6f, 48, 24), metal(0.9f, 0.2f), translation(Vec3(-0.9f, 0.6f, 0)));
        Material gloss;
        gloss.baseColor = Vec3(0.2f, 0.5f, 0.3f);
        gloss.roughness = 0.3f;
        tiny.add(sphereMesh(0.6f, 48, 24), gloss, translation(Vec3(0.9f, 0.6f, 0)) * scaling(Vec3(1, 0.7f, 1)));
        Material glass;
        glass.transmission = 1, glass.thickness = 1, glass.roughness = 0;
        tiny.add(sphereMesh(0.3f, 48, 24), glass, translation(Vec3(0, 0.3f, 1)));
        Light lamp;
        lamp.type = LightType::Sphere;
        lamp.radius = 0.3f;
        lamp.radiance = Vec3(6);
        tiny.addLight(lamp, translation(Vec3(0, 2, -1)));
        tiny.scene.environment.constant = Vec3(0.3f, 0.4f, 0.5f);
        tracer_.bind(tiny.pose());
    }
    Signals frame(int spp, uint64_t first = 0, Jitter jitter = Jitter::PerPixel) {
        FrameSampling sampling = frameOf(camera_, kExtent, spp, PathSettings(), SignalSet::all(), 3);
        sampling.firstSample = first;
        sampling.jitter = jitter;
        Signals signals;
        EXPECT_TRUE(tracer_.sample(sampling, signals));
        return signals;
    }
    Tracer tracer_;
    Camera camera_ = lookFrom(Vec3(0.4f, 1.5f, 4), Vec3(0, 0.8f, 0), 50);
};

TEST_F(SignalsContract, PartsAddUpToTheWhole) {
    for (const int spp : {1, 5, 16}) {
        const Signals s = frame(spp);
        for (int y = 0; y < kExtent.height; ++y)
            for (int x = 0; x < kExtent.width; ++x)
                for (int c = 0; c < 3; ++c) {
                    const auto at = [&](Signal signal) { return double(s[signal].at(c, x, y)); };
                    const double direct = at(Signal::Albedo) * at(Signal::DirectDiffuse) +
                                          at(Signal::SpecularAlbedo) * at(Signal::DirectSpecular);
                    const double indirect = at(Signal::Albedo) * at(Signal::IndirectDiffuse) +
                                            at(Signal::SpecularAlbedo) * at(Signal::IndirectSpecular);
                    const double tolerance = 1e-5 * (1 + at(Signal::Noisy));
                    ASSERT_NEAR(at(Signal::Emission) + direct + indirect, at(Signal::Noisy), tolerance)
                        << x << ' ' << y;
                    ASSERT_NEAR(direct, at(Signal::Direct), tolerance);
                    ASSERT_NEAR(indirect, at(Signal::Indirect), tolerance);
                    ASSERT_GE(at(Signal::Albedo), 0.01);
                    ASSERT_LE(at(Signal::Albedo), 1);
                    ASSERT_GE(at(Signal::SpecularAlbedo), 0.01);
                    ASSERT_LE(at(Signal::SpecularAlbedo), 1);
                }
    }
}

TEST_F(SignalsContract, HardlyReflectedChannelsStayUndivided) {
    // The floor's green reflectance is 0.005: stored with albedo 1.
    const Signals s = frame(4);
    int floorPixels = 0;
    for (int y = 0; y < kExtent.height; ++y)
        for (int x = 0; x < kExtent.width; ++x) {
            if (s.ids(Signal::ObjectId).at(0, x, y) != 1 || s[Signal::Albedo].at(0, x, y) < 0.69f) continue;
            if (std::abs(s[Signal::Albedo].at(0, x, y) - 0.7f) > 1e-4f) continue;
            ++floorPixels;
            EXPECT_EQ(s[Signal::Albedo].at(1, x, y), 1);
            EXPECT_LT(s[Signal::DirectDiffuse].at(1, x, y), s[Signal::DirectDiffuse].at(0, x, y) + 1e-6f);
        }
    EXPECT_GT(floorPixels, 100);
}

TEST_F(SignalsContract, GeometryIsConsistent) {
    const FrameSampling sampling = frameOf(camera_, kExtent, 1, PathSettings(), SignalSet::all());
    const CameraPose& pose = sampling.camera;
    const Signals s = frame(1, 0, Jitter::None);
    int surfaces = 0;
    for (int y = 0; y < kExtent.height; ++y)
        for (int x = 0; x < kExtent.width; ++x) {
            const auto vec = [&](Signal signal) {
                return Vec3(s[signal].at(0, x, y), s[signal].at(1, x, y), s[signal].at(2, x, y));
            };
            const float depth = s[Signal::Depth].at(0, x, y);
            if (s.ids(Signal::ObjectId).at(0, x, y) == 0) {
                EXPECT_EQ(depth, kInfinity);
                EXPECT_EQ(vec(Signal::Normal), Vec3(0));
                continue;
            }
            ++surfaces;
            EXPECT_NEAR(glm::length(vec(Signal::Normal)), 1, 1e-5);
            EXPECT_NEAR(glm::length(vec(Signal::GeometricNormal)), 1, 1e-5);
            EXPECT_NEAR(glm::length(vec(Signal::ObjectNormal)), 1, 1e-5);
            const Vec3 projected = pose.project(vec(Signal::Position));
            EXPECT_NEAR(projected.x, x + 0.5f, 2e-3);
            EXPECT_NEAR(projected.y, y + 0.5f, 2e-3);
            EXPECT_NEAR(projected.z, depth, 1e-5 * depth);
            EXPECT_NEAR(s[Signal::InverseDepth].at(0, x, y) * depth, 1, 1e-5);
            const Vec3 wo = glm::normalize(pose.position() - vec(Signal::Position));
            EXPECT_GT(glm::dot(wo, vec(Signal::GeometricNormal)), 0);
            EXPECT_GT(glm::dot(wo, vec(Signal::Normal)), 0);
            EXPECT_EQ(vec(Signal::Motion), Vec3(0));
            const IdImage& id = s.ids(Signal::Surface);
            const SurfacePoint point{id.at(0, x, y),
                                     id.at(1, x, y),
                                     {std::bit_cast<float>(id.at(2, x, y)), std::bit_cast<float>(id.at(3, x, y))},
                                     0};
            EXPECT_LT(glm::distance(tracer_.position(point), vec(Signal::Position)), 1e-5f);
        }
    EXPECT_GT(surfaces, 600);
}

TEST_F(SignalsContract, DepthGradientIsThatOfTheTangentPlane) {
    // On the floor the reciprocal depth is affine: differences of neighbours equal the gradient.
    const Signals s = frame(1, 0, Jitter::None);
    int compared = 0;
    for (int y = 0; y + 1 < kExtent.height; ++y)
        for (int x = 0; x + 1 < kExtent.width; ++x) {
            const IdImage& object = s.ids(Signal::ObjectId);
            if (object.at(0, x, y) != 1 || object.at(0, x + 1, y) != 1 || object.at(0, x, y + 1) != 1) continue;
            const Image& inverse = s[Signal::InverseDepth];
            EXPECT_NEAR(s[Signal::DepthGradient].at(0, x, y), inverse.at(0, x + 1, y) - inverse.at(0, x, y), 2e-6);
            EXPECT_NEAR(s[Signal::DepthGradient].at(1, x, y), inverse.at(0, x, y + 1) - inverse.at(0, x, y), 2e-6);
            ++compared;
        }
    EXPECT_GT(compared, 100);
}

TEST_F(SignalsContract, SumsDoNotDependOnTheSplit) {
    const Signals whole = frame(64);
    std::vector<Signals> parts;
    for (int part = 0; part < 4; ++part) parts.push_back(frame(16, static_cast<uint64_t>(part) * 16));
    for (size_t i = 0; i < whole.noisySum().size(); ++i) {
        const auto sum = [&](int part) { return parts[static_cast<size_t>(part)].noisySum().data()[i]; };
        ASSERT_EQ((sum(0) + sum(1)) + (sum(2) + sum(3)), whole.noisySum().data()[i]);
    }
}

TEST_F(SignalsContract, SampleVarianceIsThatOfSingleSamples) {
    const int spp = 16;
    const Signals many = frame(spp);
    std::vector<RunningMoments> moments(many[Signal::Noisy].size());
    for (int i = 0; i < spp; ++i) {
        const Signals single = frame(1, static_cast<uint64_t>(i));
        for (size_t k = 0; k < moments.size(); ++k) moments[k].add(single[Signal::Noisy].data()[k]);
        EXPECT_EQ(single[Signal::SampleVariance].data()[0], 0);
    }
    for (size_t k = 0; k < moments.size(); ++k) {
        const double expected = moments[k].sampleVariance();
        ASSERT_NEAR(many[Signal::SampleVariance].data()[k], expected, 1e-5 * expected + 1e-9);
    }
}

TEST_F(SignalsContract, AskingForLessChangesNothing) {
    const Signals all = frame(2);
    for (const Signal wanted :
         {Signal::Noisy, Signal::Normal, Signal::DirectDiffuse, Signal::Motion, Signal::Visibility}) {
        FrameSampling sampling = frameOf(camera_, kExtent, 2, PathSettings(), {wanted}, 3);
        Signals signals;
        ASSERT_TRUE(tracer_.sample(sampling, signals));
        EXPECT_TRUE(signals[wanted] == all[wanted]) << signalInfo(wanted).name;
    }
}

TEST(Visibility, IsTheShareOfUnblockedLightSamples) {
    // A point light above a floor, half hidden by a plate.
    TinyScene tiny;
    tiny.add(floorMesh(8), lambert(0.5f));
    tiny.add(rectangleMesh(4, 4, Facing::Y), lambert(0.5f), translation(Vec3(2, 1, 0)));
    Light lamp;
    tiny.addLight(lamp, translation(Vec3(0, 2, 0)));
    Tracer tracer;
    tracer.bind(tiny.pose());
    Signals signals;
    const Camera camera = lookFrom(Vec3(0.01f, 0.9f, 0), Vec3(0, 0, 0), 90);
    ASSERT_TRUE(
        tracer.sample(frameOf(camera, {32, 32}, 1, plainPaths(1), {Signal::Visibility, Signal::Position}), signals));
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x) {
            const float px = signals[Signal::Position].at(0, x, y);
            if (std::abs(px) < 0.02f) continue;
            EXPECT_EQ(signals[Signal::Visibility].at(0, x, y), px < 0 ? 1 : 0) << px;
        }
}

}  // namespace
}  // namespace lumi
