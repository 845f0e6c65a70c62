#pragma once
#include <map>
#include <string>
#include <vector>

#include "study/summary.h"

namespace lumi {

/// A method's wall-clock times at one number of samples: intervals over the seeds' medians.
struct StudyMeanTime {
    size_t scene = 0, method = 0;
    int spp = 1;
    Interval frameMs, poseMs, buildMs, traceMs, runMs, raysPerFrame;
    std::map<std::string, Interval> stagesMs;  ///< of run()
    std::vector<double> frameMsBySeed;         ///< in the study's order; NaN where the seed did not run
    std::vector<double> runMsBySeed,
        nsPerRayBySeed;  ///< the same; of run(), and of trace and run() over all their rays
    std::vector<double>
        tracingNsPerRayBySeed;  ///< the same, of trace and the study's tracing stages; NaN if the method has none
    Interval nsPerRay, tracingNsPerRay;

    /// By a time quantity's id (isTimeQuantity()).
    const std::vector<double>& bySeed(const std::string& quantity) const;
};

/// What the other of a pair reaches in a method's time, and how long it takes to reach its value; by straight lines
/// between the other's sample counts, in log-log space, between the largest ones that enclose it. Of seeds where the
/// other's sample counts do not reach so far nothing is known; the counts say how many those are.
struct StudyEqual {
    size_t scene = 0, method = 0;
    std::string against;  ///< a method's name, or those of a pair's entries
    int spp = 1;
    std::string metric;
    Interval ms, value;
    Interval otherAtEqualTime, differenceAtEqualTime;  ///< difference: the method's value minus the other's
    Interval otherMsAtEqualValue, timesAsLong;         ///< the other's time, as a multiple of the method's
};

/// What a stage costs, in milliseconds a frame: without it minus with it.
struct StudyStageTime {
    size_t scene = 0, whole = 0, without = 0;  ///< methods
    int spp = 1;
    Interval wholeMs, withoutMs, differenceMs;
};

struct StudyTimes {
    std::vector<StudyMeanTime> methods;
    std::vector<StudyEqual> pairs;
    std::vector<StudyStageTime> stages;

    const StudyMeanTime* find(size_t scene, size_t method, int spp) const;
};

/// Over the seeds, as Student's t has it: times are of this machine and this run.
StudyTimes summarizeTimes(const Study& study, const StudyPlan& plan, const StudyRecords& records);

}  // namespace lumi
