#pragma once
#include <filesystem>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <stop_token>
#include <string>

#include "base/messages.h"
#include "image/image.h"
#include "session/document.h"
#include "study/study.h"
#include "trace/tracer.h"

namespace lumi {

/// What a measured frame is compared with.
struct StudyReferenceFrame {
    std::string key;  ///< eight hexadecimal digits: of all that defines the image
    Image image;      ///< the mean of two halves, which are renderings with independent random numbers
    Image half;       ///< the first of them
    /// What each metric says of `half` against `image`. For the means of squares that is the reference's own error,
    /// since half - image = (half - other half) / 2 has the variance of the mean; for the others it is the least
    /// difference that means anything.
    std::map<std::string, double> floor;
    std::map<std::string, double> own;      ///< of metrics that judge one image (cpbd): the reference's
    std::map<std::string, double> details;  ///< what metrics take from the reference: "hdr_flip start_exposure"
    int64_t nonFinitePixels = 0;
    bool cached = false;
};

/// References by scene, time and what defines the image, from the cache or traced; the last few stay in memory.
class StudyReferences {
public:
    using Report = std::function<void(uint64_t samples, uint64_t target)>;
    StudyReferences(const Study& study, std::filesystem::path cache, MessageLog& log)
        : study_(study), cache_(std::move(cache)), log_(log) {}

    /// `document`: what is to be converged, at the frame's time; `spp` 0: as the study's reference. Throws
    /// Error(Interrupted).
    std::shared_ptr<const StudyReferenceFrame> get(const Document& document, std::stop_token stop,
                                                   const Report& report = {}, int spp = 0);

    /// What makes the geometry that a sampling sees: temporalSignals().
    using Trace = std::function<std::shared_ptr<const Signals>(const FrameSampling&)>;
    /// What is seen of `document`, at the frame's time, through the middle of each pixel when the shutter opens and
    /// without a lens; motion is against `earlier`, the document a frame before. It depends on nothing else, and is
    /// traced once for all jobs of a scene as long as memory is left. Null if `trace` gives that.
    std::shared_ptr<const Signals> geometry(const Document& document, const Document& earlier, const Trace& trace);

private:
    struct Kept {
        std::string key;
        std::shared_ptr<const StudyReferenceFrame> frame;
    };
    std::shared_ptr<StudyReferenceFrame> make(const Document& problem, int spp, std::stop_token stop,
                                              const Report& report);

    const Study& study_;
    std::filesystem::path cache_;
    MessageLog& log_;
    std::list<Kept> kept_;
    const Scene* geometryOf_ = nullptr;  ///< as loaded
    std::map<std::string, std::shared_ptr<const Signals>> geometry_;
};

/// The exposure at which metrics see images of a document.
float metricExposure(const Document& document);

}  // namespace lumi
