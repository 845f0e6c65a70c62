#include "study/references.h"

#include "base/files.h"
#include "base/memory.h"
#include "measure/measure.h"
#include "reference/reference.h"
#include "session/reference_spec.h"
#include "study/temporal_metrics.h"

namespace lumi {
namespace {

/// References that stay in memory: those of the measured frames of one scene, usually.
constexpr size_t kKept = 8;

/// Geometry that is kept, in pixels of all frames; each takes 16 bytes.
constexpr int64_t kGeometryPixels = int64_t(32) << 20;

Measurement measured(const std::string& metric, const Image& image, const Image& reference, float exposureEv,
                     const MetricSettings& settings) {
    ImagePair pair{image, reference, {}, exposureEv, settings};
    pair.prepare();
    return findMetric(metric).measure(pair, false);
}

Image meanOf(const Image& a, const Image& b) {
    Image mean(a.extent(), a.channels());
    for (size_t i = 0; i < mean.size(); ++i) mean.data()[i] = 0.5f * (a.data()[i] + b.data()[i]);
    return mean;
}

}  // namespace

float metricExposure(const Document& document) { return document.view(0).display.exposureEv; }

std::shared_ptr<const StudyReferenceFrame> StudyReferences::get(const Document& document, std::stop_token stop,
                                                                const Report& report, int wantedSpp) {
    const int spp = wantedSpp > 0 ? wantedSpp : study_.reference.spp;
    Document problem = document;
    problem.setText("render.seed", std::to_string(kReferenceSeed));
    if (!problem.loadedScene()->isAnimated()) problem.setTime(0);  // one reference serves all frames
    const std::string key =
        referenceKey(referenceSpec(problem)) + std::to_string(metricExposure(problem)) + ' ' + std::to_string(spp);
    for (auto kept = kept_.begin(); kept != kept_.end(); ++kept) {
        if (kept->key != key) continue;
        kept_.splice(kept_.begin(), kept_, kept);
        return kept_.front().frame;
    }
    const std::shared_ptr<StudyReferenceFrame> made = make(problem, spp, stop, report);
    const std::string& content = key;
    made->key = digest({reinterpret_cast<const uint8_t*>(content.data()), content.size()}).substr(0, 8);
    kept_.push_front({key, made});
    if (kept_.size() > kKept) kept_.pop_back();
    return kept_.front().frame;
}

std::shared_ptr<const Signals> StudyReferences::geometry(const Document& document, const Document& earlier,
                                                         const Trace& trace) {
    Document now = document, before = earlier;
    if (!now.loadedScene()->isAnimated()) now.setTime(0), before.setTime(0);  // one serves all frames
    if (geometryOf_ != now.loadedScene().get()) geometry_.clear(), geometryOf_ = now.loadedScene().get();
    const std::string key = referenceKey(referenceSpec(now)) + referenceKey(referenceSpec(before));
    if (const auto kept = geometry_.find(key); kept != geometry_.end()) return kept->second;
    const auto pinhole = [](const Document& own) {
        CameraPose camera = poseCamera(own.camera(), {own.render().width, own.render().height});
        camera.aperture = camera.shutter = 0;
        return camera;
    };
    FrameSampling sampling;
    sampling.camera = pinhole(now), sampling.previousCamera = pinhole(before);
    sampling.extent = sampling.camera.extent;
    sampling.jitter = Jitter::None;
    sampling.seed = static_cast<uint32_t>(kReferenceSeed);
    sampling.path = now.path();
    sampling.wanted = temporalSignals();
    const std::shared_ptr<const Signals> traced = trace(sampling);
    const bool fits = (static_cast<int64_t>(geometry_.size()) + 1) * sampling.extent.area() <= kGeometryPixels &&
                      2 * residentBytes() < memoryLimit();
    if (traced && fits) geometry_[key] = traced;
    return traced;
}

std::shared_ptr<StudyReferenceFrame> StudyReferences::make(const Document& problem, int spp, std::stop_token stop,
                                                           const Report& report) {
    const ReferenceGoal goal{static_cast<uint64_t>(spp / 2)};
    auto frame = std::make_shared<StudyReferenceFrame>();
    Image halves[2];
    frame->cached = true;
    for (uint32_t i = 0; i < 2; ++i) {
        ReferenceSpec spec = referenceSpec(problem);
        spec.seed += i;
        ReferenceOptions options;
        options.cache = cache_;
        options.log = &log_;
        options.stop = stop;
        if (report)
            options.progress = [&](const ReferenceProgress& progress) {
                report(i * goal.samples + progress.samples, 2 * goal.samples);
            };
        Reference half = makeReference(spec, goal, options);
        halves[i] = std::move(half.image);
        frame->cached = frame->cached && half.cached;
    }
    frame->image = meanOf(halves[0], halves[1]);
    frame->half = std::move(halves[0]);
    const float exposure = metricExposure(problem);
    const auto measure = [&](const std::string& metric, const Image& image) {
        return measured(metric, image, frame->image, exposure, study_.metricSettings);
    };
    for (const std::string& metric : study_.metrics) {
        const Measurement floor = measure(metric, frame->half);
        frame->floor[metric] = floor.value;
        // The exposures of HDR-FLIP are the reference's, whatever is compared with it.
        if (metric == "hdr_flip")
            for (const auto& [name, value] : floor.details) frame->details["hdr_flip " + name] = value;
    }
    frame->floor["mse"] = measure("mse", frame->half).value;
    if (study_.measures("cpbd")) frame->own["cpbd"] = measure("cpbd", frame->image).value;
    ImagePair itself{frame->image, frame->image};
    itself.prepare();
    frame->nonFinitePixels = itself.nonFiniteReference;
    return frame;
}

}  // namespace lumi
