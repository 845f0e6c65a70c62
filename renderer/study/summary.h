#pragma once
#include <string>
#include <vector>

#include "study/intervals.h"
#include "study/records.h"
#include "study/units.h"

namespace lumi {

/// Mean of one metric over seeds, for a method on a scene; over the measured frames, or at one.
struct StudySummary {
    size_t scene = 0, method = 0;  ///< scene may be kAllScenes
    int spp = 1;
    std::string metric;
    int64_t frame = -1;  ///< -1: over all that are measured
    Interval interval;   ///< of the corrected values, where there are some
    double uncorrected = 0;
    int64_t missing = 0;  ///< units (seeds, or frames and seeds) without a value, which do not count
};

/// The places of the methods that ran with one number of samples.
struct StudyRanking {
    size_t scene = 0;
    int spp = 1;
    std::string metric;
    struct Place {
        size_t method = 0;
        Rank rank;
        /// Paired difference to the method with the best mean, over the units where both have a value; not known for
        /// that one itself.
        Interval toBest;
    };
    std::vector<Place> places;  ///< best mean first
};

/// Mean squared error of a method's linear image, in what stays and what averages away; over the measured frames.
struct StudyBias {
    size_t scene = 0, method = 0;
    int spp = 1;
    int seeds = 0;
    BiasVariance parts;
    double biasShare = 0;                   ///< of the mean squared error; NaN if that is not above 0
    Interval meanSquaredError;              ///< over seeds
    Interval squaredBias, variance, share;  ///< jackknife over seeds: from three on
    int64_t pixels = 0;                     ///< that count: finite in every image and the reference, over all frames
    int64_t pixelsLeftOut = 0;              ///< the others
};

/// Pixels that are NaN or infinite in the images of a method, or in their reference. They count in no metric.
struct StudyNonFinite {
    size_t scene = 0, method = 0;
    int spp = 1;
    int64_t pixels = 0, images = 0, allImages = 0;  ///< images: those with any
};

/// What it costs to switch a stage off: differences without the stage minus with it, in units that have both.
struct StudyStageEffect {
    size_t scene = 0, whole = 0, without = 0;  ///< methods
    int spp = 1;
    std::string metric;
    Interval wholeMean, withoutMean, difference;
};

/// How an error falls with the number of samples.
struct StudySlope {
    size_t scene = 0, method = 0;
    std::string metric;
    Interval slope;  ///< in log-log space, over seeds; -0.5 is 1/sqrt(n)
};

/// How many samples of another entry give the same error.
struct StudyEquivalent {
    size_t scene = 0, method = 0, against = 0;
    int spp = 1;
    std::string metric;
    Interval samples;           ///< over the seeds where the other reaches it
    bool extrapolated = false;  ///< beyond the other's samples: by its error falling as 1/n in the mean square
};

struct StudySummaries {
    std::vector<StudySummary> metrics;  ///< over the measured frames; all scenes last
    std::vector<StudySummary> frames;   ///< each measured frame
    std::vector<StudyRanking> rankings;
    std::vector<StudyBias> biases;
    std::vector<StudySlope> slopes;
    std::vector<StudyEquivalent> equivalents;
    std::vector<StudyStageEffect> stages;
    std::vector<StudyNonFinite> nonFinite;
};

StudySummaries summarize(const Study& study, const StudyPlan& plan, const StudyRecords& records);

/// The part of summarize() that reads images.
std::vector<StudyBias> separateBiases(const Study& study, const StudyPlan& plan, const StudyRecords& records);

/// A seed's value of a metric at each number of samples that a method ran with; NaN where it has none.
struct SeedCurve {
    std::vector<double> spp, value;
};
/// One for each of the study's seeds.
std::vector<SeedCurve> seedCurves(const Study& study, const StudyRowIndex& rows, size_t scene, size_t method,
                                  const std::string& metric);

}  // namespace lumi
