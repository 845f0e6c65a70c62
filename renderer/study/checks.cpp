#include "study/checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace lumi {
namespace {

using Verdict = StudyCheckResult::Verdict;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// The method of an entry that is neither swept nor without a stage.
std::optional<size_t> methodOf(const Study& study, const StudyPlan& plan, const std::string& entry) {
    for (size_t i = 0; i < plan.methods.size(); ++i)
        if (study.entries[plan.methods[i].entry].name == entry && plan.methods[i].coordinates.empty() &&
            !plan.methods[i].whole)
            return i;
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
    // What is left when some units have no value may be just those that speak for the claim.
    const bool all = std::all_of(excess.begin(), excess.end(), [](double value) { return std::isfinite(value); });
    if (excess.empty() || !all) return Verdict::Unknown;
    const Interval interval = meanInterval(excess, study.intervals.level, intervalMethod(study));
    if (interval.mean > 0) return interval.known() && interval.low > 0 ? Verdict::Fails : Verdict::FailsWithinNoise;
    return interval.known() && interval.high <= 0 ? Verdict::Holds : Verdict::WithinNoise;
}

std::vector<double> excessOf(const StudyCheck& check, const std::vector<double>& own,
                             const std::vector<double>* other) {
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

/// The sample counts that an entry runs with, ascending.
std::vector<int> countsOf(const Study& study, const std::string& name) {
    const StudyEntry* entry = study.entry(name);
    std::vector<int> counts = entry && !entry->spp.empty() ? entry->spp : study.spp;
    std::sort(counts.begin(), counts.end());
    return counts;
}

/// What claims are judged by.
struct Evidence {
    const Study& study;
    const StudyPlan& plan;
    const StudyRowIndex& rows;
    const StudyTimes& times;
};

/// A quantity of every seed, in the study's order; nothing if the method did not run so.
std::vector<double> seedValues(const Evidence& evidence, size_t scene, size_t method, int spp,
                               const std::string& quantity) {
    if (isTimeQuantity(quantity)) {
        const StudyMeanTime* time = evidence.times.find(scene, method, spp);
        return time ? time->bySeed(quantity) : std::vector<double>{};
    }
    std::vector<double> values;
    bool any = false;
    for (const SeedCurve& curve : seedCurves(evidence.study, evidence.rows, scene, method, quantity)) {
        const auto point = std::find(curve.spp.begin(), curve.spp.end(), static_cast<double>(spp));
        any = any || point != curve.spp.end();
        values.push_back(point == curve.spp.end() ? kNaN : curve.value[static_cast<size_t>(point - curve.spp.begin())]);
    }
    return any ? values : std::vector<double>{};
}

/// On the curve through the points, straight in log-log space, and a little beyond its ends (by a quarter of the
/// place).
double onCurve(std::vector<std::pair<double, double>> points, double at) {
    std::sort(points.begin(), points.end());
    std::vector<double> x, y;
    for (const auto& [place, value] : points) x.push_back(place), y.push_back(value);
    const double inside = logLogAt(x, y, at);
    if (std::isfinite(inside) || x.size() < 2) return inside;
    const bool below = at < x.front() && at >= x.front() / 1.25, above = at > x.back() && at <= x.back() * 1.25;
    if (!below && !above) return kNaN;
    const size_t i = below ? 0 : x.size() - 2;
    const double slope = std::log(y[i + 1] / y[i]) / std::log(x[i + 1] / x[i]);
    return y[i] * std::pow(at / x[i], slope);
}

/// The values of the curve through the others' sample counts, seed by seed, where `check.atEqual` is what the method
/// has.
std::vector<double> curveValues(const Evidence& evidence, const StudyCheck& check, size_t scene, size_t method,
                                int spp) {
    const std::vector<double> places = seedValues(evidence, scene, method, spp, check.atEqual);
    std::vector<std::vector<std::pair<double, double>>> points(places.size());
    for (const std::string& name : check.against) {
        const std::optional<size_t> other = methodOf(evidence.study, evidence.plan, name);
        for (const int count : other ? countsOf(evidence.study, name) : std::vector<int>{}) {
            const std::vector<double> a = seedValues(evidence, scene, *other, count, check.atEqual),
                                      b = seedValues(evidence, scene, *other, count, check.metric);
            for (size_t seed = 0; seed < places.size() && seed < a.size() && seed < b.size(); ++seed)
                if (std::isfinite(a[seed]) && std::isfinite(b[seed])) points[seed].emplace_back(a[seed], b[seed]);
        }
    }
    std::vector<double> values;
    for (size_t seed = 0; seed < places.size(); ++seed) values.push_back(onCurve(points[seed], places[seed]));
    return values;
}

/// A claim at equal cost.
StudyCheckResult resultAtEqual(const Evidence& evidence, const StudyCheck& check, const std::vector<double>& own,
                               size_t method, StudyCheckResult result) {
    for (const std::string& name : check.against) result.against += (result.against.empty() ? "" : ", ") + name;
    const std::vector<double> values = curveValues(evidence, check, result.scene, method, result.spp);
    result.ratio = meanInterval({}, evidence.study.intervals.level);
    if (values.size() != own.size()) return result;
    result.ratio = ratioInterval(evidence.study, own, values);
    result.verdict = judge(evidence.study, excessOf(check, own, &values));
    return result;
}

/// One claim on one scene. Every name in it gets a verdict: what is not there makes it unknown, and never goes unsaid.
StudyCheckResult resultOf(const Evidence& evidence, size_t index, size_t scene, int spp) {
    const Study& study = evidence.study;
    const StudyCheck& check = study.checks[index];
    const bool bySeed = check.timed() || !check.atEqual.empty();
    const auto valuesOf = [&](const std::optional<size_t>& method) {
        if (!method) return std::vector<double>{};
        return bySeed ? seedValues(evidence, scene, *method, spp, check.metric)
                      : unitValues(study, evidence.rows, scene, *method, spp, check.metric);
    };
    const std::optional<size_t> method = methodOf(study, evidence.plan, check.entry);
    const std::vector<double> own = valuesOf(method);
    StudyCheckResult result{
        index,       scene,           spp, "", meanInterval(own, study.intervals.level, intervalMethod(study)), {},
        check.bound, Verdict::Unknown};
    if (!check.atEqual.empty() && method) return resultAtEqual(evidence, check, own, *method, result);
    if (check.against.empty()) {
        result.verdict = judge(study, excessOf(check, own, nullptr));
        return result;
    }
    std::optional<StudyCheckResult> worst;
    for (const std::string& name : check.against) {
        const std::vector<double> values = valuesOf(methodOf(study, evidence.plan, name));
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

}  // namespace

std::vector<StudyCheckResult> checkClaims(const Study& study, const StudyPlan& plan, const StudyRecords& records,
                                          const StudyTimes& times) {
    std::vector<StudyCheckResult> results;
    const StudyRowIndex rows(records);
    for (size_t index = 0; index < study.checks.size(); ++index)
        for (const size_t scene : rows.scenes()) {
            // On average means over all scenes; where there is one scene that is the average.
            const bool average = scene == kAllScenes || rows.scenes().size() == 1;
            if (study.checks[index].onAverage ? !average : scene == kAllScenes) continue;
            if (!study.checks[index].scene.empty() && study.checks[index].scene != study.scenes[scene].name) continue;
            for (const int spp : countsOf(study, study.checks[index].entry))
                results.push_back(resultOf({study, plan, rows, times}, index, scene, spp));
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

std::string claimText(const Study& study, const StudyCheck& check) {
    if (!check.title.empty()) return check.title;
    std::string text = fmt::format("{} of {} {} {:g}", titleOf(study, check.metric), check.entry,
                                   check.atLeast ? "at least" : "at most", check.bound);
    for (size_t i = 0; i < check.against.size(); ++i)
        text += fmt::format("{}{}",
                            i == 0                          ? " times that of "
                            : i + 1 == check.against.size() ? " and "
                                                            : ", ",
                            check.against[i]);
    if (!check.atEqual.empty()) text += " at equal " + titleOf(study, check.atEqual);
    return text + (check.onAverage ? ", on average over the scenes" : "");
}

}  // namespace lumi
