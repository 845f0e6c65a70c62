#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "study/checks.h"
#include "study/statistics.h"
#include "study/study_file.h"
#include "support/expect_error.h"

namespace lumi::test {
namespace {

using Of = StudyStatistic::Of;

Study parse(const std::string& members) {
    return parseStudy(
        R"({"version": 1, "scenes": ["cornell", "room"], "seeds": [1, 2, 3], "metrics": ["mse"], )" + members + "}",
        "s.json", "");
}

double reducedTo(Of of, double value, const std::vector<float>& pixels, const std::string& channel = "") {
    Image image({static_cast<int>(pixels.size()), 1}, 2);
    for (size_t i = 0; i < pixels.size(); ++i)
        image.at(0, static_cast<int>(i), 0) = pixels[i], image.at(1, static_cast<int>(i), 0) = 2 * pixels[i];
    StudyStatistic statistic;
    statistic.tap = "t", statistic.of = of, statistic.value = value, statistic.channel = channel;
    return reduced(statistic, image, "XY");
}

TEST(Statistics, ReduceABufferOverItsFinitePixels) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<float> pixels{4, nan, 0, 1, 2, 3, std::numeric_limits<float>::infinity()};
    EXPECT_EQ(reducedTo(Of::Mean, 0, pixels), 2);
    EXPECT_EQ(reducedTo(Of::Mean, 0, pixels, "Y"), 4);
    EXPECT_EQ(reducedTo(Of::Least, 0, pixels), 0);
    EXPECT_EQ(reducedTo(Of::Most, 0, pixels), 4);
    EXPECT_EQ(reducedTo(Of::Percentile, 75, pixels), 3);
    EXPECT_EQ(reducedTo(Of::Percentile, 100, pixels), 4);
    EXPECT_EQ(reducedTo(Of::ShareBelow, 1, pixels), 0.2);
    EXPECT_EQ(reducedTo(Of::ShareAtLeast, 1, pixels), 0.8);
    EXPECT_TRUE(std::isnan(reducedTo(Of::Mean, 0, {nan, nan})));
    expectError(ErrorKind::BadInput, [&] { reducedTo(Of::Mean, 0, pixels, "Z"); }, {"no channel \"Z\""});
}

TEST(Statistics, RefuseWhatMeansNothing) {
    const auto refused = [](const std::string& statistics, const std::initializer_list<std::string>& parts) {
        expectError(
            ErrorKind::BadInput,
            [&] { parse(R"("entries": [{"module": "none"}], "statistics": [)" + statistics + "]"); }, parts);
    };
    refused(R"({"name": "x"})", {"one of \"tap\""});
    refused(R"({"name": "x", "tap": "a", "of": "mean", "rays": "all"})", {"one of \"tap\""});
    refused(R"({"name": "x", "tap": "sampleCuont", "of": "mean"})",
            {"unknown buffer of the entries' modules \"sampleCuont\""});
    refused(R"({"name": "mse", "rays": "all"})", {"\"mse\" is the name of something else"});
    refused(R"({"name": "frame_ms", "rays": "all"})", {"is the name of something else"});
    refused(R"({"name": "x", "over": "y", "under": "y"})", {"unknown over \"y\""});
    refused(R"({"name": "x", "tap": "a", "of": {"percentile": 99, "share-below": 1}})", {"one of"});
    refused(R"({"name": "x", "metric": "mse", "reference-spp": 48})", {"multiple of 32"});
}

/// "m" costs 10 + seed ms; "o" runs at three costs, 8, 16 and 32 ms + seed, with the error 64 / cost.
struct Timed {
    Study study = parse(R"("statistics": [{"name": "cost", "rays": "all"}],
        "entries": [{"name": "m", "module": "none"}, {"name": "o1", "module": "none"}, {"name": "o2", "module": "none"}, {"name": "o3", "module": "none"}],
        "pairs": [{"entry": "m", "against": ["o1", "o2", "o3"]}])");
    StudyPlan plan = planStudy(study);
    StudyRecords records;

    Timed() {
        for (size_t scene = 0; scene < 2; ++scene)
            for (const int seed : study.seeds)
                for (size_t method = 0; method < 4; ++method) {
                    StudyTime time;
                    time.scene = scene, time.method = method, time.seed = seed, time.raysPerFrame = 1e6;
                    time.runMs = (method == 0 ? 10 : 8 << (method - 1)) + seed;
                    records.times.push_back(time);
                    StudyRow row;
                    row.scene = scene, row.method = method, row.seed = seed;
                    row.metrics = {{"mse", method == 0 ? 2.0 : 64 / time.runMs}, {"cost", time.runMs}};
                    records.rows.push_back(row);
                }
    }
    std::vector<StudyCheckResult> claim(const std::string& entry, const std::string& metric,
                                        const std::vector<std::string>& against, const std::string& atEqual,
                                        double bound) {
        StudyCheck check;
        check.entry = entry, check.metric = metric, check.against = against, check.atEqual = atEqual,
        check.bound = bound;
        study.checks = {check};
        return checkClaims(study, plan, records, summarizeTimes(study, plan, records));
    }
};

TEST(Statistics, ClaimsAtEqualTimeTakeTheOthersAsOneCurve) {
    Timed timed;
    using Verdict = StudyCheckResult::Verdict;
    // The curve has 64 / (10 + seed) where m has 2: ratios from 11/32 to 13/32.
    for (const char* cost : {"frame_ms", "cost"}) {
        const std::vector<StudyCheckResult> results = timed.claim("m", "mse", {"o3", "o1", "o2"}, cost, 0.6);
        ASSERT_EQ(results.size(), 2u);
        EXPECT_EQ(results[0].verdict, Verdict::Holds);
        EXPECT_NEAR(results[0].ratio.mean, 2 / (64 * (1 / 11.0 + 1 / 12.0 + 1 / 13.0) / 3), 1e-6);
        EXPECT_EQ(timed.study.checks[0].timed(), std::string(cost) == "frame_ms");
    }
    EXPECT_EQ(timed.claim("m", "mse", {"o1", "o2", "o3"}, "frame_ms", 0.3)[0].verdict, Verdict::Fails);
    EXPECT_EQ(timed.claim("m", "frame_ms", {"o1", "o2"}, "mse", 1)[0].verdict, Verdict::Unknown)
        << "far out of the curve";
    EXPECT_EQ(timed.claim("o1", "ns_per_ray", {"m"}, "", 0.9)[0].verdict, Verdict::Holds);
    EXPECT_EQ(timed.claim("m", "ns_per_ray", {"o1"}, "", 1)[0].verdict, Verdict::Fails);
    // Of a ray's 11 to 13 ns half is tracing, where the other's are all.
    for (StudyTime& time : timed.records.times)
        time.stagesMs = {{"shading", time.runMs / (time.method == 0 ? 2 : 1)}, {"rest", 1}};
    EXPECT_EQ(timed.claim("m", "tracing_ns_per_ray", {"o1"}, "", 1)[0].verdict, Verdict::Unknown)
        << "no stage is named";
    timed.study.tracingStages = {"shading"};
    EXPECT_EQ(timed.claim("m", "tracing_ns_per_ray", {"o1"}, "", 0.7)[0].verdict, Verdict::Holds);
    EXPECT_EQ(timed.claim("m", "tracing_ns_per_ray", {"o1"}, "", 0.5)[0].verdict, Verdict::Fails);
    StudyCheck here = timed.study.checks[0];
    here.scene = "room";
    timed.study.checks = {here};
    const auto results =
        checkClaims(timed.study, timed.plan, timed.records, summarizeTimes(timed.study, timed.plan, timed.records));
    ASSERT_EQ(results.size(), 1u);
    EXPECT_EQ(results[0].scene, 1u);
}

TEST(Statistics, PairsTakeSeveralEntriesAsOneCurve) {
    const Timed timed;
    const StudyTimes times = summarizeTimes(timed.study, timed.plan, timed.records);
    ASSERT_EQ(times.pairs.size(), 2u * 2) << "each scene, the metric and the statistic";
    EXPECT_EQ(times.pairs[0].against, "o1, o2, o3");
    EXPECT_NEAR(times.pairs[0].otherAtEqualTime.mean, 64 * (1 / 11.0 + 1 / 12.0 + 1 / 13.0) / 3, 1e-6);
    EXPECT_NEAR(times.pairs[0].otherMsAtEqualValue.mean, 32, 1e-6);
}

/// Two methods at two sample counts each, whose costs lie between one another's: one curve by cost, which bends.
TEST(Times, SeveralMethodsAreOneCurveByWhatTheyCost) {
    const Study study =
        parseStudy(R"({"version": 1, "scenes": ["cornell"], "seeds": [1, 2], "spp": [1, 2], "metrics": ["mse"],
        "entries": [{"name": "m", "module": "none"}, {"name": "a", "module": "none"}, {"name": "b", "module": "none"}],
        "pairs": [{"entry": "m", "against": ["a", "b"]}]})",
                   "s.json", "");
    const StudyPlan plan = planStudy(study);
    StudyRecords records;
    const double ms[3][2] = {{12, 12}, {8, 32}, {16, 64}}, mse[3][2] = {{2.5, 2.5}, {8, 2}, {3, 1}};
    for (const int seed : study.seeds)
        for (const int spp : study.spp)
            for (size_t method = 0; method < 3; ++method) {
                StudyTime time;
                time.method = method, time.spp = spp, time.seed = seed, time.runMs = ms[method][spp - 1];
                records.times.push_back(time);
                StudyRow row;
                row.method = method, row.spp = spp, row.seed = seed, row.frame = 0;
                row.metrics = {{"mse", mse[method][spp - 1]}};
                records.rows.push_back(row);
            }
    const StudyTimes times = summarizeTimes(study, plan, records);
    ASSERT_EQ(times.pairs.size(), 2u);
    const double at = std::log(12.0 / 8) / std::log(2.0), reached = std::log(2.5 / 3) / std::log(2.0 / 3);
    EXPECT_NEAR(times.pairs[0].otherAtEqualTime.mean, std::pow(8, 1 - at) * std::pow(3, at), 1e-9);
    EXPECT_NEAR(times.pairs[0].otherMsAtEqualValue.mean, 16 * std::pow(2, reached), 1e-9);
}

}  // namespace
}  // namespace lumi::test
