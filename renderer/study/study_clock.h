#pragma once
#include <string>
#include <vector>

#include "study/plan.h"

namespace lumi {

/// How far a study has come, and how long the rest will take.
///
/// Frames and references are two kinds of work, each with a speed of its own that is learned as they are done: a
/// reference may come from the cache, which no count of samples tells beforehand. A job like one that was run (scene,
/// samples and methods alike) takes as long as that did; else the speed in its scene counts, else that in all.
class StudyClock {
public:
    StudyClock(const Study& study, const StudyPlan& plan);

    /// A job whose results are there.
    void found(size_t job);
    void begin(size_t job, double nowS);
    /// Within a job, `share` of its frames and so many reference samples being done.
    void at(double frameShare, double referenceSamples, double nowS);
    void end(double nowS);

    /// Share of all work, in [0,1].
    double fraction();
    /// Seconds left; below 0 while nothing is known.
    double leftS(double nowS) const;

private:
    struct Job {
        size_t scene = 0;
        double frames = 0;      ///< samples a pixel over all frames, and the methods' work
        double references = 0;  ///< samples a pixel
        std::string kind;       ///< jobs of one kind take alike
        bool done = false;
        double framesS = -1, referencesS = -1;  ///< what they took, of jobs that were run
    };
    /// Seconds that a job's frames will take; below 0 if nothing tells.
    double expectedFramesS(const Job& job) const;
    double expectedReferencesS(const Job& job) const;
    bool knowsAll() const;

    std::vector<Job> jobs_;
    size_t current_ = 0;
    bool running_ = false;
    double frameShare_ = 0, referenceSamples_ = 0;      ///< of the current job
    double lastS_ = 0, framesS_ = 0, referencesS_ = 0;  ///< of the current job so far
    double shown_ = 0;                                  ///< a bar never goes back
};

}  // namespace lumi
