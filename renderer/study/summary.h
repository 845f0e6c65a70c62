#pragma once
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "study/intervals.h"
#include "study/records.h"

namespace lumi {

/// Index of "all scenes together" in summaries.
inline constexpr size_t kAllScenes = static_cast<size_t>(-1);

/// Mean of one metric over seeds, for a method on a scene; over the measured frames, or at one.
struct StudySummary {
    size_t scene = 0, method = 0;  ///< scene may be kAllScenes
    int spp = 1;
    std::string metric;
    int64_t frame = -1;  ///< -1: over all that are measured
    Interval interval;   ///< of the corrected values, where there are some
    double uncorrected = 0;
};

/// The places of the methods that ran with one number of samples.
struct StudyRanking {
    size_t scene = 0;
    int spp = 1;
    std::string metric;
    struct Place {
        size_t method = 0;
        Rank rank;
        Interval toBest;  ///< paired difference to the method with the best mean; not known for that one itself
    };
    std::vector<Place> places;  ///< best mean first
};

/// Mean squared error of a method's linear image, in what stays and what averages away; over the measured frames.
struct StudyBias {
    size_t scene = 0, method = 0;
    int spp = 1;
    int seeds = 0;
    BiasVariance parts;
    Interval meanSquaredError;  ///< over seeds
    Interval squaredBias;       ///< jackknife over seeds
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
    Interval samples;           ///< over seeds
    bool extrapolated = false;  ///< beyond the other's samples: by its error falling as 1/n in the mean square
};

struct StudySummaries {
    std::vector<StudySummary> metrics;  ///< over the measured frames; all scenes last
    std::vector<StudySummary> frames;   ///< each measured frame
    std::vector<StudyRanking> rankings;
    std::vector<StudyBias> biases;
    std::vector<StudySlope> slopes;
    std::vector<StudyEquivalent> equivalents;
};

StudySummaries summarize(const Study& study, const StudyPlan& plan, const StudyRecords& records);

/// The part of summarize() that reads images.
std::vector<StudyBias> separateBiases(const Study& study, const StudyPlan& plan, const StudyRecords& records);

bool higherIsBetter(const std::string& metric);
IntervalMethod intervalMethod(const Study& study);

/// Rows by method and number of samples.
class StudyRowIndex {
public:
    explicit StudyRowIndex(const StudyRecords& records);
    const std::vector<const StudyRow*>& of(size_t method, int spp) const;
    const std::vector<int>& spp() const { return spp_; }            ///< ascending
    const std::vector<size_t>& scenes() const { return scenes_; }   ///< kAllScenes last, where there are several

private:
    std::map<std::pair<size_t, int>, std::vector<const StudyRow*>> rows_;
    std::vector<int> spp_;
    std::vector<size_t> scenes_;
};

/// Values of a metric by unit (seed, or frame and seed), in an order that is the same for all methods. `frame` -1: all.
std::vector<double> unitValues(const Study& study, const StudyRowIndex& rows, size_t scene, size_t method, int spp,
                               const std::string& metric, int64_t frame = -1);

}  // namespace lumi
