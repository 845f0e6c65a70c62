#pragma once
#include <string>
#include <vector>

#include "study/summary.h"
#include "study/times.h"

namespace lumi {

/// What became of one claim on one scene, at one number of samples.
struct StudyCheckResult {
    enum class Verdict { Holds, WithinNoise, FailsWithinNoise, Fails, Unknown };
    size_t check = 0;  ///< index into Study::checks
    size_t scene = 0;
    int spp = 1;
    std::string against;  ///< of several the one that it holds worst against; empty: a bound that stands alone
    Interval value;       ///< the entry's
    Interval ratio;       ///< to the other's, where there is one
    double bound = 0;     ///< of the value or the ratio
    Verdict verdict = Verdict::Unknown;

    /// Are the means as claimed? What is unknown does not count as held.
    bool asClaimed() const { return verdict == Verdict::Holds || verdict == Verdict::WithinNoise; }
};

/// A result for each scene (or the mean over all) and each sample count that the claim's entry runs with. Holds: as
/// claimed, and the interval of the units' differences to the bound tells so. WithinNoise: as claimed, but the interval
/// does not tell it from the contrary. Fails: not as claimed, and the interval tells so. FailsWithinNoise: the means
/// are not as claimed, but the interval does not tell. Unknown: a unit has no value, or one of those to compare with
/// did not run at this count. A claim about times, or at equal cost, is judged seed by seed; against several entries at
/// equal cost these are one curve, straight between its points in log-log space; more than a quarter out of its range
/// there is no value.
std::vector<StudyCheckResult> checkClaims(const Study& study, const StudyPlan& plan, const StudyRecords& records,
                                          const StudyTimes& times);

/// "holds", "holds within the noise", "fails within the noise", "fails", "unknown".
const char* verdictText(StudyCheckResult::Verdict verdict);
/// The claim in words: its own, or "rmse of svgf at most 1.03 times eaw's".
std::string claimText(const Study& study, const StudyCheck& check);

}  // namespace lumi
