#pragma once
#include <bit>
#include <string>
#include <utility>
#include <vector>

#include "trace/camera_starts.h"
#include "trace/contract_check.h"

namespace lumi::contract {

inline Vec3 colourAt(const Image& image, Pixel p) {
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
    /// Of the camera ray of that sample.
    Vec3 direction(Pixel p) const {
        std::vector<PathStart> starts;
        makeStarts(sampling, p, {p.x + 1, p.y + 1}, sampling.firstSample, starts);
        return starts[0].ray.direction;
    }
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

/// Rules of where things are and were; the others stand in contract_check.cpp.
ContractFinding depthGradients(const CheckedFrame& frame);
ContractFinding motionVectors(const CheckedFrame& frame);
ContractFinding depthMotion(const CheckedFrame& frame);
ContractFinding jitterDistribution(const CheckedFrame& frame);

}  // namespace lumi::contract
