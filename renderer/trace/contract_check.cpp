#include "trace/contract_check.h"

#include <fmt/format.h>

#include <cmath>

#include "trace/contract_rules.h"

namespace lumi {
namespace contract {
namespace {

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

/// What illumination by those two signals makes of a surface's colours.
Vec3 remodulated(const Signals& s, Pixel p, Signal diffuse, Signal specular) {
    return colourAt(s[Signal::Albedo], p) * colourAt(s[diffuse], p) +
           colourAt(s[Signal::SpecularAlbedo], p) * colourAt(s[specular], p);
}

double relativeTo(const Vec3& expected, const Vec3& found) {
    return maxComponent(glm::abs(found - expected)) / (maxComponent(glm::abs(expected)) + 1e-4);
}

ContractFinding lightingIdentity(const CheckedFrame& frame) {
    Rule rule("albedo x illumination + emission = radiance, relative to it", 1e-3);
    const Signals& s = frame.signals;
    frame.eachPixel([&](Pixel p) {
        const Vec3 sum = colourAt(s[Signal::Emission], p) +
                         remodulated(s, p, Signal::DirectDiffuse, Signal::DirectSpecular) +
                         remodulated(s, p, Signal::IndirectDiffuse, Signal::IndirectSpecular);
        rule.check(p, relativeTo(colourAt(s[Signal::Noisy], p), sum));
    });
    return rule.take();
}

ContractFinding remodulatedSums(const CheckedFrame& frame) {
    Rule rule("direct and indirect are albedo x illumination, relative to it", 1e-3);
    const Signals& s = frame.signals;
    frame.eachPixel([&](Pixel p) {
        const Vec3 direct = remodulated(s, p, Signal::DirectDiffuse, Signal::DirectSpecular);
        const Vec3 indirect = remodulated(s, p, Signal::IndirectDiffuse, Signal::IndirectSpecular);
        const double errors[] = {relativeTo(direct, colourAt(s[Signal::Direct], p)),
                                 relativeTo(indirect, colourAt(s[Signal::Indirect], p))};
        rule.check(p, errors[0] <= errors[1] ? errors[1] : errors[0]);
    });
    return rule.take();
}

/// Samples that are not negative vary most if one of them is all of the light.
ContractFinding possibleVariance(const CheckedFrame& frame) {
    Rule rule("sample variance is what samples of that mean can have, relative to the most", 1e-3);
    const int samples = frame.signals.samplesPerPixel();
    frame.eachPixel([&](Pixel p) {
        const Vec3 mean = colourAt(frame.signals[Signal::Noisy], p);
        const Vec3 found = colourAt(frame.signals[Signal::SampleVariance], p);
        double worst = 0, shown = 0;
        for (int c = 0; c < 3; ++c) {
            const double most = samples > 1 ? samples * sqr(double(mean[c])) : 0, variance = found[c];
            const double error = std::max(-variance, variance - most) / (most + 1e-8);
            if (!(error <= worst)) worst = error, shown = variance;
        }
        rule.check(p, worst, shown);
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
}  // namespace contract

std::string ContractFinding::text() const {
    if (checked == 0) return rule + ": nothing to check";
    if (holds()) return fmt::format("{}: holds in {} pixel{}", rule, checked, checked == 1 ? "" : "s");
    return fmt::format("{}: broken in {} of {} pixels; worst at ({}, {}): {:.4g}{}{}, allowed {:.4g}", rule, violations,
                       checked, worst.x, worst.y, value, unit.empty() ? "" : " ", unit, limit);
}

SignalSet contractSignals() { return SignalSet::all(); }

std::vector<ContractFinding> checkSignals(const Signals& signals, const FrameSampling& sampling, const Tracer& tracer,
                                          const Tracer& before) {
    using namespace contract;
    const CheckedFrame frame{signals, sampling, tracer, before};
    return {finiteValues(frame),
            unitNormals(frame),
            range01(frame, Signal::Albedo),
            range01(frame, Signal::SpecularAlbedo),
            range01(frame, Signal::Roughness),
            range01(frame, Signal::Visibility),
            lightingIdentity(frame),
            remodulatedSums(frame),
            possibleVariance(frame),
            linearDepth(frame),
            depthGradients(frame),
            motionVectors(frame),
            depthMotion(frame),
            jitterDistribution(frame),
            knownIds(frame),
            emptySky(frame)};
}

}  // namespace lumi
