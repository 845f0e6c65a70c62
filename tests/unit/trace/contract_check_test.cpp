// The checker of the signals' contract, checked: each rule breaks when its signal is damaged, and no other does.
#include "trace/contract_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <regex>

#include "support/transport_scene.h"

namespace lumi {
namespace {

using namespace test;

constexpr Extent2 kExtent{40, 30};

/// A frame, and where to damage it: `surface` is a diffuse one, `sky` shows nothing.
struct Frame {
    Signals signals;
    Pixel surface, sky;
};

struct Damage {
    const char* what;
    const char* rule;  ///< part of the rule that has to break, or of several
    std::function<void(Frame&)> apply;
};

/// Whether `rule` has one of `parts`, which bars part.
bool means(const std::string& parts, const std::string& rule) { return std::regex_search(rule, std::regex(parts)); }

class ContractCheck : public testing::Test {
protected:
    void SetUp() override {
        TinyScene tiny;
        tiny.add(floorMesh(8), lambert(Vec3(0.7f, 0.5f, 0.4f)));
        tiny.add(sphereMesh(0.6f, 48, 24), metal(0.9f, 0.2f), translation(Vec3(-0.9f, 0.6f, 0)));
        tiny.scene.environment.constant = Vec3(0.3f, 0.4f, 0.5f);
        tracer_.bind(tiny.pose());
    }
    FrameSampling sampling(Jitter jitter) const {
        FrameSampling s = frameOf(lookFrom(Vec3(0.5f, 1.5f, 4), Vec3(0, 0.9f, 0), 50), kExtent, 2, PathSettings(),
                                  contractSignals(), 3);
        s.previousCamera = poseCamera(lookFrom(Vec3(0.4f, 1.5f, 4), Vec3(0, 0.8f, 0), 50), kExtent);
        s.jitter = jitter;
        s.frame = 1, s.firstSample = 2;
        return s;
    }
    Frame frame(const FrameSampling& sampling) {
        Frame f;
        EXPECT_TRUE(tracer_.sample(sampling, f.signals));
        f.sky = {-1, -1}, f.surface = {-1, -1};
        for (int y = 0; y < kExtent.height; ++y)
            for (int x = 0; x < kExtent.width; ++x) {
                const uint32_t object = f.signals.ids(Signal::ObjectId).at(0, x, y);
                if (object == 0) f.sky = {x, y};
                if (object == 1 && f.surface.x < 0) f.surface = {x, y};
            }
        EXPECT_GE(f.sky.x, 0);
        EXPECT_GE(f.surface.x, 0);
        return f;
    }
    /// Exactly the rule that holds `damage.rule` breaks; it says in how many pixels and where.
    void expectBreaks(const Damage& damage, const FrameSampling& sampling) {
        SCOPED_TRACE(damage.what);
        Frame f = frame(sampling);
        damage.apply(f);
        bool found = false;
        for (const ContractFinding& finding : checkSignals(f.signals, sampling, tracer_, tracer_)) {
            const bool meant = means(damage.rule, finding.rule);
            EXPECT_EQ(finding.holds(), !meant) << finding.text();
            if (!meant) continue;
            found = true;
            EXPECT_NE(finding.text().find("broken in"), std::string::npos) << finding.text();
        }
        EXPECT_TRUE(found) << "no rule is called " << damage.rule;
    }

    Tracer tracer_;
};

float& value(Frame& f, Signal signal, int channel, Pixel p) { return f.signals[signal].at(channel, p.x, p.y); }

TEST_F(ContractCheck, AnUndamagedFrameHolds) {
    for (const Jitter jitter : {Jitter::PerPixel, Jitter::PerFrame, Jitter::None}) {
        const FrameSampling s = sampling(jitter);
        int checked = 0;
        for (const ContractFinding& finding : checkSignals(frame(s).signals, s, tracer_, tracer_)) {
            EXPECT_TRUE(finding.holds()) << finding.text();
            checked += finding.checked > 0;
        }
        EXPECT_EQ(checked, 16) << "each rule has something to check";
    }
}

/// Parallel rays see the floor rise through the plane of the camera, where 1/depth has no bound.
TEST_F(ContractCheck, HoldsWhereSurfacesCrossAnOrthographicCamerasPlane) {
    FrameSampling s = sampling(Jitter::PerPixel);
    Camera camera = lookFrom(Vec3(0, 1, 2), Vec3(0));
    camera.projection = Projection::Orthographic, camera.yMag = 3;
    s.camera = s.previousCamera = poseCamera(camera, kExtent);
    const Frame f = frame(s);
    bool close = false;
    for (int y = 0; y < kExtent.height; ++y)
        for (int x = 0; x < kExtent.width; ++x) close |= f.signals[Signal::Depth].at(0, x, y) < 0.02f;
    EXPECT_TRUE(close) << "the floor comes to the camera's plane";
    for (const ContractFinding& finding : checkSignals(f.signals, s, tracer_, tracer_))
        EXPECT_TRUE(finding.holds()) << finding.text();
}

// Where it is in a triangle of two kilometres, a float tells to a tenth of a millimetre.
TEST_F(ContractCheck, HoldsCloseToLargeTriangles) {
    TinyScene tiny;
    tiny.add(floorMesh(2000), lambert(0.7f));
    tiny.scene.environment.constant = Vec3(1);
    tracer_.bind(tiny.pose());
    for (const Jitter jitter : {Jitter::PerFrame, Jitter::PerPixel}) {
        FrameSampling s = sampling(jitter);
        s.camera = s.previousCamera = poseCamera(lookFrom(Vec3(31, 0.1f, 53), Vec3(31, 0, 52.7f), 10), kExtent);
        Signals signals;
        ASSERT_TRUE(tracer_.sample(s, signals));
        for (const ContractFinding& finding : checkSignals(signals, s, tracer_, tracer_))
            EXPECT_TRUE(finding.holds()) << finding.text();
    }
}

TEST_F(ContractCheck, CountsPixels) {
    const FrameSampling s = sampling(Jitter::PerPixel);
    const Frame f = frame(s);
    int64_t surfaces = 0;
    for (int y = 0; y < kExtent.height; ++y)
        for (int x = 0; x < kExtent.width; ++x) surfaces += f.signals.ids(Signal::ObjectId).at(0, x, y) != 0;
    int rules = 0;
    for (const ContractFinding& finding : checkSignals(f.signals, s, tracer_, tracer_)) {
        const bool all =
            finding.rule.find("lies in") != std::string::npos || finding.rule.find("finite") != std::string::npos;
        const bool some = finding.rule.find("normals are unit") != std::string::npos;
        if (finding.rule.find("uniform") != std::string::npos) {
            EXPECT_LT(finding.checked, surfaces) << "not where the ball is seen edge-on";
            EXPECT_GT(finding.checked, surfaces * 9 / 10);
            ++rules;
        }
        if (all || some) {
            EXPECT_EQ(finding.checked, all ? kExtent.area() : surfaces) << finding.rule;
            ++rules;
        }
    }
    EXPECT_EQ(rules, 8);
}

// Its offsets repeat from tile to tile.
TEST_F(ContractCheck, BlueNoiseIsUniform) {
    for (const uint32_t seed : {0u, 1u, 2u}) {
        FrameSampling s = sampling(Jitter::PerPixel);
        s.extent = {320, 180}, s.seed = seed;
        s.camera = s.previousCamera = poseCamera(lookFrom(Vec3(0.5f, 1.5f, 4), Vec3(0, 0.9f, 0), 50), s.extent);
        s.path.sampler = SamplerKind::BlueNoise;
        Signals signals;
        ASSERT_TRUE(tracer_.sample(s, signals));
        for (const ContractFinding& finding : checkSignals(signals, s, tracer_, tracer_))
            EXPECT_TRUE(finding.holds()) << finding.text();
    }
}

TEST_F(ContractCheck, ALensLeavesNoOffsetsToCheck) {
    for (const Jitter jitter : {Jitter::PerPixel, Jitter::PerFrame}) {
        FrameSampling s = sampling(jitter);
        s.camera.aperture = 0.05f, s.camera.focus = 4;
        const char* rule = jitter == Jitter::PerPixel ? "uniform" : "one sub-pixel offset";
        bool found = false;
        for (const ContractFinding& finding : checkSignals(frame(s).signals, s, tracer_, tracer_)) {
            if (finding.rule.find(rule) == std::string::npos) continue;
            found = true;
            EXPECT_EQ(finding.checked, 0);
            EXPECT_NE(finding.text().find("nothing to check"), std::string::npos) << finding.text();
        }
        EXPECT_TRUE(found) << rule;
    }
}

TEST_F(ContractCheck, EachDamagedColourBreaksItsRule) {
    const Damage damages[] = {
        {"an infinity", "is finite|direct and", [](Frame& f) { value(f, Signal::Indirect, 1, f.surface) = kInfinity; }},
        {"a NaN", "is finite|variance is",
         [](Frame& f) { value(f, Signal::SampleVariance, 2, f.sky) = std::numeric_limits<float>::quiet_NaN(); }},
        {"a negative variance", "variance is",
         [](Frame& f) { value(f, Signal::SampleVariance, 0, f.surface) = -0.1f; }},
        {"a large variance", "variance is", [](Frame& f) { value(f, Signal::SampleVariance, 1, f.surface) = 100; }},
        {"direct", "direct and", [](Frame& f) { value(f, Signal::Direct, 0, f.surface) += 0.1f; }},
        {"indirect", "direct and", [](Frame& f) { value(f, Signal::Indirect, 2, f.surface) += 0.1f; }},
        {"albedo above 1", "albedo lies", [](Frame& f) { value(f, Signal::Albedo, 0, f.sky) = 1.5f; }},
        {"negative albedo", "albedo lies", [](Frame& f) { value(f, Signal::Albedo, 2, f.sky) = -0.1f; }},
        {"specular albedo", "specularAlbedo lies", [](Frame& f) { value(f, Signal::SpecularAlbedo, 0, f.sky) = 1.5f; }},
        {"roughness", "roughness lies", [](Frame& f) { value(f, Signal::Roughness, 0, f.surface) = 1.01f; }},
        {"visibility", "visibility lies", [](Frame& f) { value(f, Signal::Visibility, 0, f.surface) = -0.01f; }},
        {"the sum", "radiance, rel", [](Frame& f) { value(f, Signal::Noisy, 0, f.surface) += 1; }},
        {"emission", "radiance", [](Frame& f) { value(f, Signal::Emission, 1, f.sky) *= 1.1f; }},
        {"direct diffuse", "radiance|direct and", [](Frame& f) { value(f, Signal::DirectDiffuse, 2, f.surface) += 1; }},
        {"indirect diffuse", "radiance|direct and",
         [](Frame& f) { value(f, Signal::IndirectDiffuse, 0, f.surface) += 1; }},
        {"direct specular", "radiance|direct and",
         [](Frame& f) { value(f, Signal::DirectSpecular, 0, f.surface) += 1; }},
        {"indirect specular", "radiance|direct and",
         [](Frame& f) { value(f, Signal::IndirectSpecular, 0, f.surface) += 1; }},
        {"albedo of a lit surface", "radiance|direct and",
         [](Frame& f) { value(f, Signal::Albedo, 0, f.surface) *= 0.9f; }},
    };
    const FrameSampling s = sampling(Jitter::PerPixel);
    for (const Damage& damage : damages) expectBreaks(damage, s);
}

TEST_F(ContractCheck, EachDamagedGeometryBreaksItsRule) {
    const Damage damages[] = {
        {"normal", "unit", [](Frame& f) { value(f, Signal::Normal, 1, f.surface) *= 1.01f; }},
        {"geometric normal", "unit", [](Frame& f) { value(f, Signal::GeometricNormal, 1, f.surface) = 0; }},
        {"object normal", "unit", [](Frame& f) { value(f, Signal::ObjectNormal, 1, f.surface) += 0.1f; }},
        {"depth", "depth is", [](Frame& f) { value(f, Signal::Depth, 0, f.surface) *= 1.01f; }},
        {"inverse depth", "depth is", [](Frame& f) { value(f, Signal::InverseDepth, 0, f.surface) *= 0.99f; }},
        {"depth's gradient", "depthGradient", [](Frame& f) { value(f, Signal::DepthGradient, 1, f.surface) *= 1.01f; }},
        {"a gradient upside down", "depthGradient",
         [](Frame& f) { value(f, Signal::DepthGradient, 1, f.surface) *= -1; }},
        {"motion", "motion leads", [](Frame& f) { value(f, Signal::Motion, 0, f.surface) += 0.1f; }},
        {"motion upside down", "motion leads", [](Frame& f) { value(f, Signal::Motion, 1, f.surface) *= -1; }},
        {"motion in depth", "third channel", [](Frame& f) { value(f, Signal::Motion, 2, f.surface) += 0.01f; }},
        {"the sky's motion", "motion leads", [](Frame& f) { value(f, Signal::Motion, 1, f.sky) += 0.1f; }},
        {"depth of the sky's motion", "third channel", [](Frame& f) { value(f, Signal::Motion, 2, f.sky) = 1; }},
        {"object id", "ids exist",
         [](Frame& f) { f.signals.ids(Signal::ObjectId).at(0, f.surface.x, f.surface.y) = 99; }},
        {"material id", "ids exist",
         [](Frame& f) { f.signals.ids(Signal::MaterialId).at(0, f.surface.x, f.surface.y) = 0; }},
        {"a hole", "sky has", [](Frame& f) { f.signals.ids(Signal::ObjectId).at(0, f.surface.x, f.surface.y) = 0; }},
        {"near sky", "sky has", [](Frame& f) { value(f, Signal::Depth, 0, f.sky) = 1e6f; }},
        {"sky with a place", "sky has", [](Frame& f) { value(f, Signal::Position, 1, f.sky) = 1; }},
        {"sky with a normal", "sky has", [](Frame& f) { value(f, Signal::Normal, 1, f.sky) = 1; }},
    };
    const FrameSampling s = sampling(Jitter::PerPixel);
    for (const Damage& damage : damages) expectBreaks(damage, s);
}

// Motion that agrees with the tracer's own idea of where things were, and that idea is wrong.
TEST_F(ContractCheck, MotionIsHeldToWhereThingsWere) {
    TinyScene tiny;
    tiny.add(floorMesh(8), lambert(Vec3(0.7f, 0.5f, 0.4f)));
    const int ball = tiny.add(sphereMesh(0.6f, 48, 24), metal(0.9f, 0.2f), Mat4(1));
    AnimationChannel moves;
    moves.node = tiny.scene.instances[static_cast<size_t>(ball)].node;
    tiny.scene.nodes[static_cast<size_t>(moves.node)].hasMatrix = false;
    moves.property = AnimatedProperty::Translation, moves.components = 3;
    moves.times = {0, 1}, moves.values = {-0.9f, 0.6f, 0, 0.9f, 0.6f, 0};
    tiny.scene.animations.emplace_back();
    tiny.scene.animations.back().channels.push_back(moves), tiny.scene.animations.back().duration = 1;
    Tracer before;
    before.bind(tiny.pose({0.25f, 0.25f, 0.25f}));
    const FrameSampling s = sampling(Jitter::PerPixel);
    const auto motionHolds = [&](float previous) {
        tracer_.bind(tiny.pose({0.5f, 0.5f, previous}));
        Signals signals;
        EXPECT_TRUE(tracer_.sample(s, signals));
        bool holds = true;
        for (const ContractFinding& finding : checkSignals(signals, s, tracer_, before)) {
            const bool motion = finding.rule.find("motion") != std::string::npos;
            if (motion) holds &= finding.holds();
            else EXPECT_TRUE(finding.holds()) << finding.text();
        }
        return holds;
    };
    EXPECT_TRUE(motionHolds(0.25f));
    EXPECT_FALSE(motionHolds(0.3f));
    EXPECT_FALSE(motionHolds(0.5f)) << "as a thing that stands still";
}

template <class F>
void eachSurface(const Frame& f, F body) {
    for (int y = 0; y < kExtent.height; ++y)
        for (int x = 0; x < kExtent.width; ++x)
            if (f.signals.ids(Signal::ObjectId).at(0, x, y) != 0) body(Pixel{x, y});
}

// Every pixel has a time of its own, and the cameras of both frames are where they were then.
TEST_F(ContractCheck, ACameraMayMoveWhileItsShutterIsOpen) {
    FrameSampling s = sampling(Jitter::PerPixel);
    s.shutterOpen = true;
    const auto poseAt = [&](const Vec3& eye) { return poseCamera(lookFrom(eye, Vec3(0, 0.9f, 0), 50), kExtent); };
    s.cameraTrack = {s.camera, poseAt(Vec3(0.8f, 1.7f, 3.6f))};
    s.previousCameraTrack = {s.previousCamera, poseAt(Vec3(0.3f, 1.3f, 4.4f))};
    Signals signals;
    ASSERT_TRUE(tracer_.sample(s, signals));
    for (const ContractFinding& finding : checkSignals(signals, s, tracer_, tracer_))
        EXPECT_TRUE(finding.holds()) << finding.text();
    s.previousCameraTrack.clear();
    for (const ContractFinding& finding : checkSignals(signals, s, tracer_, tracer_))
        EXPECT_EQ(finding.holds(), finding.rule.find("motion") == std::string::npos) << finding.text();
}

TEST_F(ContractCheck, JitterThatIsNotAsSaidIsFound) {
    // Sideways in the image, so that the depth stays what it was; off the planes of the ball.
    const auto shift = [](Frame& f, const FrameSampling& s, Pixel p, float pixels) {
        const float step = pixels * s.camera.pixelSize() * value(f, Signal::Depth, 0, p);
        for (int c = 0; c < 3; ++c) value(f, Signal::Position, c, p) += step * s.camera.worldFromCamera[0][c];
    };
    const FrameSampling perFrame = sampling(Jitter::PerFrame), perPixel = sampling(Jitter::PerPixel);
    expectBreaks({"one pixel has another offset", "one sub-pixel offset",
                  [&](Frame& f) { shift(f, perFrame, f.surface, 0.2f); }},
                 perFrame);
    for (const Jitter jitter : {Jitter::PerFrame, Jitter::None}) {
        const FrameSampling s = sampling(jitter);
        expectBreaks({"every pixel has another offset", "one sub-pixel offset|depthGradient",
                      [&](Frame& f) { eachSurface(f, [&](Pixel p) { shift(f, s, p, 0.5f); }); }},
                     s);
    }
    expectBreaks({"every offset is too far right", "uniform|depthGradient",
                  [&](Frame& f) { eachSurface(f, [&](Pixel p) { shift(f, perPixel, p, 0.4f); }); }},
                 perPixel);
}

}  // namespace
}  // namespace lumi
