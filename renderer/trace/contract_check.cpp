#include "trace/contract_check.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <bitset>
#include <cmath>
#include <optional>

#include "math/statistics.h"
#include "trace/blue_noise.h"

namespace lumi {
namespace {

Vec3 colourAt(const Image& image, Pixel p) {
    return {image.at(0, p.x, p.y), image.at(1, p.x, p.y), image.at(2, p.x, p.y)};
}

/// Collects one rule over the pixels of a frame.
class Rule {
public:
    Rule(std::string rule, double limit, std::string unit = "") {
        finding_.rule = std::move(rule);
        finding_.limit = limit;
        finding_.unit = std::move(unit);
    }
    /// `error` must be at most the limit; NaN breaks the rule.
    void check(Pixel p, double error, double shown) {
        ++finding_.checked;
        if (error <= finding_.limit) return;
        ++finding_.violations;
        if (finding_.violations > 1 && !(error > worst_)) return;
        worst_ = error;
        finding_.worst = p;
        finding_.value = shown;
    }
    void check(Pixel p, double error) { check(p, error, error); }
    /// One test of `pixels` together.
    void checkTogether(int64_t pixels, double error) {
        check({0, 0}, error);
        finding_.checked = pixels;
        finding_.violations *= pixels;
    }
    ContractFinding take() { return std::move(finding_); }

private:
    ContractFinding finding_;
    double worst_ = 0;
};

/// A frame's signals by pixel, with what several rules ask.
struct CheckedFrame {
    const Signals& signals;
    const FrameSampling& sampling;
    const Tracer& tracer;
    const Tracer& before;  ///< bound to the previous frame's pose

    bool sky(Pixel p) const { return signals.ids(Signal::ObjectId).at(0, p.x, p.y) == 0; }
    SurfacePoint point(Pixel p) const {
        const IdImage& s = signals.ids(Signal::Surface);
        SurfacePoint point;
        point.instance = s.at(0, p.x, p.y), point.primitive = s.at(1, p.x, p.y);
        point.barycentrics = {std::bit_cast<float>(s.at(2, p.x, p.y)), std::bit_cast<float>(s.at(3, p.x, p.y))};
        point.time = time(p);
        return point;
    }
    /// When the frame's first sample of the pixel, whose surface it shows, was taken.
    float time(Pixel p) const { return sampling.timeOf(p.x, p.y, sampling.firstSample); }
    CameraPose camera(Pixel p) const { return sampling.cameraAt(time(p)); }
    template <class F>
    void eachPixel(F body) const {
        for (int y = 0; y < signals.extent().height; ++y)
            for (int x = 0; x < signals.extent().width; ++x) body(Pixel{x, y});
    }
    template <class F>
    void eachSurface(F body) const {
        eachPixel([&](Pixel p) {
            if (!sky(p)) body(p);
        });
    }
};

ContractFinding finiteValues(const CheckedFrame& frame) {
    Rule rule("every value is finite (depth of the sky apart)", 0);
    frame.eachPixel([&](Pixel p) {
        int broken = 0;
        for (int s = 0; s < kSignalCount; ++s) {
            const auto signal = static_cast<Signal>(s);
            if (signalInfo(signal).isId || !frame.signals.available().has(signal)) continue;
            if (signal == Signal::Depth && frame.sky(p)) continue;
            const Image& image = frame.signals[signal];
            for (int c = 0; c < image.channels(); ++c) broken += !std::isfinite(image.at(c, p.x, p.y));
        }
        rule.check(p, broken);
    });
    return rule.take();
}

ContractFinding unitNormals(const CheckedFrame& frame) {
    Rule rule("normals are unit vectors", 1e-3);
    frame.eachSurface([&](Pixel p) {
        double worst = 1;
        for (const Signal signal : {Signal::Normal, Signal::GeometricNormal, Signal::ObjectNormal}) {
            const double length = glm::length(colourAt(frame.signals[signal], p));
            if (!(std::abs(length - 1) <= std::abs(worst - 1))) worst = length;
        }
        rule.check(p, std::abs(worst - 1), worst);
    });
    return rule.take();
}

ContractFinding range01(const CheckedFrame& frame, Signal signal) {
    Rule rule(fmt::format("{} lies in [0,1]", signalInfo(signal).name), 1e-5);
    const auto outside = [](double v) { return std::max({-v, v - 1, 0.0}); };
    frame.eachPixel([&](Pixel p) {
        const Image& image = frame.signals[signal];
        double worst = 0;
        for (int c = 0; c < image.channels(); ++c) {
            const double v = image.at(c, p.x, p.y);
            if (!(outside(v) <= outside(worst))) worst = v;
        }
        rule.check(p, std::isnan(worst) ? worst : outside(worst), worst);
    });
    return rule.take();
}

ContractFinding lightingIdentity(const CheckedFrame& frame) {
    Rule rule("albedo x illumination + emission = radiance, relative to it", 1e-3);
    const Signals& s = frame.signals;
    frame.eachPixel([&](Pixel p) {
        const Vec3 sum = colourAt(s[Signal::Emission], p) +
                         colourAt(s[Signal::Albedo], p) *
                             (colourAt(s[Signal::DirectDiffuse], p) + colourAt(s[Signal::IndirectDiffuse], p)) +
                         colourAt(s[Signal::SpecularAlbedo], p) *
                             (colourAt(s[Signal::DirectSpecular], p) + colourAt(s[Signal::IndirectSpecular], p));
        const Vec3 noisy = colourAt(s[Signal::Noisy], p);
        rule.check(p, maxComponent(glm::abs(sum - noisy)) / (maxComponent(glm::abs(noisy)) + 1e-4));
    });
    return rule.take();
}

ContractFinding linearDepth(const CheckedFrame& frame) {
    Rule rule("depth is the linear view depth of the position, relative to it", 1e-3);
    frame.eachSurface([&](Pixel p) {
        const double depth = frame.signals[Signal::Depth].at(0, p.x, p.y);
        const double expected = frame.camera(p).project(colourAt(frame.signals[Signal::Position], p)).z;
        const double inverse = frame.signals[Signal::InverseDepth].at(0, p.x, p.y);
        rule.check(p, std::max(std::abs(depth - expected) / std::abs(expected), std::abs(inverse * depth - 1)), depth);
    });
    return rule.take();
}

ContractFinding motionVectors(const CheckedFrame& frame) {
    Rule rule("motion leads to the surface's previous pixel", 0.01, "px");
    const FrameSampling& s = frame.sampling;
    frame.eachSurface([&](Pixel p) {
        const SurfacePoint point = frame.point(p);
        const Vec3 now = frame.camera(p).project(frame.tracer.position(point));
        const Vec3 before = s.previousCameraAt(point.time).project(frame.before.position(point));
        if (!(before.z > 0) && s.previousCamera.projection == Projection::Perspective) return;
        const Vec3 motion = colourAt(frame.signals[Signal::Motion], p);
        const double error = std::hypot(before.x - now.x - motion.x, before.y - now.y - motion.y);
        // Far off the image a float holds no hundredth of a pixel.
        rule.check(p, error / std::max(1.0, std::hypot(motion.x, motion.y) * 1e-3), error);
    });
    return rule.take();
}

/// Offset of the frame's first sample from the pixel's upper left corner, in pixels; through a pinhole.
Vec2 offsetAt(const CheckedFrame& frame, Pixel p) {
    const Vec3 at = frame.camera(p).project(colourAt(frame.signals[Signal::Position], p));
    return {at.x - static_cast<float>(p.x), at.y - static_cast<float>(p.y)};
}

/// Whether a float holds places on the surface to a few hundredths of a pixel: it is neither too far away for that nor
/// seen edge-on, where the barycentrics of a sliver do not.
bool holdsOffsets(const CheckedFrame& frame, Pixel p) {
    const Vec3 place = colourAt(frame.signals[Signal::Position], p);
    const CameraPose camera = frame.camera(p);
    const Vec3 away =
        camera.projection == Projection::Perspective ? glm::normalize(place - camera.position()) : camera.forward();
    if (std::abs(glm::dot(away, colourAt(frame.signals[Signal::GeometricNormal], p))) < 0.05f) return false;
    const float scale = std::max(maxComponent(glm::abs(place)), frame.signals[Signal::Depth].at(0, p.x, p.y));
    const Vec3 aside = place + Vec3(camera.worldFromCamera[0]) * (scale * 0x1p-22f);
    return glm::distance(Vec2(camera.project(aside)), Vec2(camera.project(place))) < 0.05f;
}

/// Needs a pinhole and enough surface; else there is nothing to check.
ContractFinding uniformOffsets(const CheckedFrame& frame) {
    constexpr int kCells = 8, kEnough = 5 * kCells * kCells, kSide = BlueNoiseTile::kSide;
    Rule rule("sub-pixel offsets are uniform (chi-square test; -log10 of the p-value)", 6);
    std::array<double, kCells * kCells> observed{};
    int64_t count = 0;
    std::bitset<kSide * kSide> seen;
    const bool repeats = frame.sampling.path.sampler == SamplerKind::BlueNoise;
    frame.eachSurface([&](Pixel p) {
        // Blue noise repeats from tile to tile: the same offsets again would make a small deviation a sure one.
        const size_t place = static_cast<size_t>(p.y % kSide * kSide + p.x % kSide);
        if ((repeats && seen[place]) || !holdsOffsets(frame, p)) return;
        seen[place] = true;
        const Vec2 offset = offsetAt(frame, p);
        const auto cell = [&](float o) { return std::clamp(static_cast<int>(o * kCells), 0, kCells - 1); };
        observed[static_cast<size_t>(cell(offset.y) * kCells + cell(offset.x))] += 1;
        ++count;
    });
    if (frame.sampling.camera.aperture > 0 || count < kEnough) return rule.take();
    const std::vector<double> expected(observed.size(),
                                       static_cast<double>(count) / static_cast<double>(observed.size()));
    rule.checkTogether(count, -std::log10(std::max(chiSquareTest(observed, expected), 1e-300)));
    return rule.take();
}

ContractFinding oneOffset(const CheckedFrame& frame) {
    Rule rule("all pixels have the frame's one sub-pixel offset", 0.1, "px");
    if (frame.sampling.camera.aperture > 0) return rule.take();
    std::optional<Vec2> first;
    frame.eachSurface([&](Pixel p) {
        if (!holdsOffsets(frame, p)) return;
        if (!first) first = offsetAt(frame, p);
        rule.check(p, glm::distance(offsetAt(frame, p), *first));
    });
    return rule.take();
}

ContractFinding jitterDistribution(const CheckedFrame& frame) {
    return frame.sampling.jitter == Jitter::PerPixel ? uniformOffsets(frame) : oneOffset(frame);
}

ContractFinding knownIds(const CheckedFrame& frame) {
    Rule rule("object and material ids exist", 0);
    const Scene& scene = *frame.tracer.scene().scene;
    frame.eachSurface([&](Pixel p) {
        const uint32_t object = frame.signals.ids(Signal::ObjectId).at(0, p.x, p.y);
        const uint32_t material = frame.signals.ids(Signal::MaterialId).at(0, p.x, p.y);
        const bool good = object <= scene.instances.size() && material >= 1 && material <= scene.materials.size();
        rule.check(p, good ? 0 : 1, object);
    });
    return rule.take();
}

ContractFinding emptySky(const CheckedFrame& frame) {
    Rule rule("the sky has infinite depth, no normal and no position", 0);
    frame.eachPixel([&](Pixel p) {
        const float depth = frame.signals[Signal::Depth].at(0, p.x, p.y);
        const bool empty = depth == kInfinity && isBlack(colourAt(frame.signals[Signal::Normal], p)) &&
                           isBlack(colourAt(frame.signals[Signal::Position], p)) &&
                           frame.signals[Signal::InverseDepth].at(0, p.x, p.y) == 0;
        rule.check(p, frame.sky(p) == empty ? 0 : 1, depth);
    });
    return rule.take();
}

}  // namespace

std::string ContractFinding::text() const {
    if (checked == 0) return rule + ": nothing to check";
    if (holds()) return fmt::format("{}: holds in {} pixel{}", rule, checked, checked == 1 ? "" : "s");
    return fmt::format("{}: broken in {} of {} pixels; worst at ({}, {}): {:.4g}{}{}, allowed {:.4g}", rule, violations,
                       checked, worst.x, worst.y, value, unit.empty() ? "" : " ", unit, limit);
}

SignalSet contractSignals() { return SignalSet::all(); }

std::vector<ContractFinding> checkSignals(const Signals& signals, const FrameSampling& sampling, const Tracer& tracer,
                                          const Tracer& before) {
    const CheckedFrame frame{signals, sampling, tracer, before};
    return {finiteValues(frame),
            unitNormals(frame),
            range01(frame, Signal::Albedo),
            range01(frame, Signal::SpecularAlbedo),
            range01(frame, Signal::Roughness),
            range01(frame, Signal::Visibility),
            lightingIdentity(frame),
            linearDepth(frame),
            motionVectors(frame),
            jitterDistribution(frame),
            knownIds(frame),
            emptySky(frame)};
}

}  // namespace lumi
