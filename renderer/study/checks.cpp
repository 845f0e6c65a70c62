#include "study/checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace lumi {
namespace {

using Verdict = StudyCheckResult::Verdict;

/// The method of an entry that is neither swept nor without a stage.
std::optional<size_t> methodOf(const Study& study, const StudyPlan& plan, const std::string& entry) {
    for (size_t i = 0; i < plan.methods.size(); ++i)
        if (study.entries[plan.methods[i].entry].name == entry && plan.methods[i].coordinates.empty() && !plan.methods[i].whole) return i;
    return std::nullopt;
}

/// The ratio of two means over the units where both have a value, by the jackknife.
Interval ratioInterval(const Study& study, const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> x, y;
    for (size_t i = 0; i < a.size(); ++i)
        if (std::isfinite(a[i]) && std::isfinite(b[i])) x.push_back(a[i]), y.push_back(b[i]);
    const double all = finiteMean(x) / finiteMean(y);
    std::vector<double> without;
    for (size_t k = 0; k < x.size() && x.size() > 2; ++k) {
        std::vector<double> own = x, other = y;
        own.erase(own.begin() + static_cast<std::ptrdiff_t>(k));
        other.erase(other.begin() + static_cast<std::ptrdiff_t>(k));
        without.push_back(finiteMean(own) / finiteMean(other));
    }
    Interval interval = meanInterval(pseudoValues(all, without), study.intervals.level, intervalMethod(study));
    interval.mean = all;
    return interval;
}

/// `excess` is how far each unit lies beyond the bound on the wrong side.
Verdict judge(const Study& study, const std::vector<double>& excess) {
    const Interval interval = meanInterval(excess, study.intervals.level, intervalMethod(study));
    if (interval.count == 0) return Verdict::Unknown;
    if (interval.mean > 0) return interval.known() && interval.low > 0 ? Verdict::Fails : Verdict::FailsWithinNoise;
    return interval.known() && interval.high <= 0 ? Verdict::Holds : Verdict::WithinNoise;
}

std::vector<double> excessOf(const StudyCheck& check, const std::vector<double>& own, const std::vector<double>* other) {
    std::vector<double> excess;
    for (size_t i = 0; i < own.size(); ++i) {
        const double beyond = own[i] - check.bound * (other ? (*other)[i] : 1);
        excess.push_back(check.atLeast ? -beyond : beyond);
    }
    return excess;
}

/// Of two results the one that says more against the claim.
bool isWorse(const StudyCheck& check, const StudyCheckResult& a, const StudyCheckResult& b) {
    if (a.verdict != b.verdict) return a.verdict > b.verdict;  // they are declared from the best to the worst
    return check.atLeast ? a.ratio.mean < b.ratio.mean : a.ratio.mean > b.ratio.mean;
}

/// One claim on one scene. Every name in it gets a verdict: what is not there makes it unknown, and never goes unsaid.
StudyCheckResult resultOf(const Study& study, const StudyPlan& plan, const StudyRowIndex& rows, size_t index, size_t scene, int spp) {
    const StudyCheck& check = study.checks[index];
    const std::optional<size_t> method = methodOf(study, plan, check.entry);
    const std::vector<double> own = method ? unitValues(study, rows, scene, *method, spp, check.metric) : std::vector<double>{};
    StudyCheckResult result{index, scene, spp, "", meanInterval(own, study.intervals.level, intervalMethod(study)), {}, check.bound, Verdict::Unknown};
    if (check.against.empty()) {
        result.verdict = judge(study, excessOf(check, own, nullptr));
        return result;
    }
    std::optional<StudyCheckResult> worst;
    for (const std::string& name : check.against) {
        const std::optional<size_t> other = methodOf(study, plan, name);
        const std::vector<double> values = other ? unitValues(study, rows, scene, *other, spp, check.metric) : std::vector<double>{};
        StudyCheckResult one = result;
        one.against = name;
        if (values.size() == own.size()) {
            one.ratio = ratioInterval(study, own, values);
            one.verdict = judge(study, excessOf(check, own, &values));
        } else {
            one.ratio = meanInterval({}, study.intervals.level);
        }
        if (!worst || isWorse(check, one, *worst)) worst = std::move(one);
    }
    return *worst;
}

/// The sample counts that an entry runs with, ascending.
std::vector<int> countsOf(const Study& study, const std::string& name) {
    const StudyEntry* entry = study.entry(name);
    std::vector<int> counts = entry && !entry->spp.empty() ? entry->spp : study.spp;
    std::sort(counts.begin(), counts.end());
    return counts;
}

}  // namespace

std::vector<StudyCheckResult> checkClaims(const Study& study, const StudyPlan& plan, const StudyRecords& records) {
    std::vector<StudyCheckResult> results;
    const StudyRowIndex rows(records);
    for (size_t index = 0; index < study.checks.size(); ++index)
        for (const size_t scene : rows.scenes()) {
            // On average means over all scenes; where there is one scene that is the average.
            const bool average = scene == kAllScenes || rows.scenes().size() == 1;
            if (study.checks[index].onAverage ? !average : scene == kAllScenes) continue;
            for (const int spp : countsOf(study, study.checks[index].entry))
                results.push_back(resultOf(study, plan, rows, index, scene, spp));
        }
    return results;
}

const char* verdictText(StudyCheckResult::Verdict verdict) {
    switch (verdict) {
        case Verdict::Holds: return "holds";
        case Verdict::WithinNoise: return "holds within the noise";
        case Verdict::FailsWithinNoise: return "fails within the noise";
        case Verdict::Fails: return "fails";
        case Verdict::Unknown: return "unknown";
    }
    return "";
}

std::string claimText(const StudyCheck& check) {
    if (!check.title.empty()) return check.title;
    std::string text = fmt::format("{} of {} {} {:g}", titleOf(check.metric), check.entry, check.atLeast ? "at least" : "at most", check.bound);
    for (size_t i = 0; i < check.against.size(); ++i)
        text += fmt::format("{}{}", i == 0 ? " times that of " : i + 1 == check.against.size() ? " and " : ", ", check.against[i]);
    return text + (check.onAverage ? ", on average over the scenes" : "");
}

}  // namespace lumi
