#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "image/exr.h"
#include "math/hash.h"
#include "study/report.h"
#include "study/results.h"
#include "study/run_job.h"
#include "study/study_file.h"
#include "support/temporary_folder.h"

namespace lumi::test {
namespace {

/// Records of two methods on two scenes with three seeds, made up: "b" is worse by one everywhere.
struct Sample {
    Study study = parseStudy(
        R"({"version": 1, "scenes": ["cornell", "room"], "spp": [1, 4, 16], "seeds": [1, 2, 3], "metrics": ["mse", "ssim"],
        "entries": [{"name": "a", "module": "none"}, {"name": "b", "module": "none"}]})",
        "t.json", "");
    StudyPlan plan;
    StudyRecords records;
};

Sample sample() {
    Sample s;
    s.study.entries[1].name = "b, \"quoted\"";
    s.plan = planStudy(s.study);
    for (size_t scene = 0; scene < 2; ++scene)
        for (const int spp : s.study.spp)
            for (const int seed : s.study.seeds)
                for (size_t method = 0; method < 2; ++method) {
                    StudyRow row;
                    row.scene = scene, row.method = method, row.frame = 0, row.spp = spp, row.seed = seed;
                    const double mse = (1.0 + 0.01 * seed + static_cast<double>(method)) / spp;
                    row.metrics = {{"mse", mse + 0.001}, {"ssim", 0.9 - mse / 10}};
                    row.corrected = {{"mse", mse}};
                    s.records.rows.push_back(row);
                }
    return s;
}

TEST(Results, CsvHasARowForEachImage) {
    const Sample s = sample();
    const std::string csv = resultsCsv(s.study, s.plan, s.records);
    EXPECT_TRUE(csv.starts_with("scene,frame,entry,spp,seed,mse,ssim,mse_corrected,nonfinite_pixels\n"));
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 36);
    EXPECT_NE(csv.find("cornell,0,\"b, \"\"quoted\"\"\",1,1,"), std::string::npos);
}

TEST(Results, SummariesAreMeansOverSeedsWithRanksAndSlopes) {
    Sample s = sample();
    StudyRecords withoutImages = s.records;
    for (StudyRow& row : withoutImages.rows) row.frame = -1;  // sequences have no images whose bias could be read
    const StudySummaries all = summarize(s.study, s.plan, withoutImages);
    const auto found = std::find_if(all.metrics.begin(), all.metrics.end(), [](const StudySummary& summary) {
        return summary.scene == 0 && summary.method == 1 && summary.spp == 4 && summary.metric == "mse";
    });
    ASSERT_NE(found, all.metrics.end());
    EXPECT_NEAR(found->interval.mean, 2.02 / 4, 1e-12) << "the corrected values count";
    EXPECT_NEAR(found->uncorrected, 2.02 / 4 + 0.001, 1e-12);
    EXPECT_EQ(found->interval.count, 3);
    for (const StudyRanking& ranking : all.rankings) {
        EXPECT_EQ(ranking.places.front().method, 0u) << ranking.metric;
        EXPECT_TRUE(ranking.places.front().rank.certain()) << ranking.metric;
        EXPECT_NEAR(std::abs(ranking.places.back().toBest.mean), (ranking.metric == "mse" ? 1.0 : 0.1) / ranking.spp,
                    1e-12);
    }
    EXPECT_EQ(all.rankings.size(), 3u * 3 * 2) << "two scenes and all together, three sample counts, two metrics";
    for (const StudySlope& slope : all.slopes) EXPECT_NEAR(slope.slope.mean, -1, 1e-9);
    EXPECT_EQ(all.slopes.size(), 4u) << "errors only, a scene and method each";
}

/// A seed without a value leaves the mean, and its pairs leave the comparison; both are counted.
TEST(Results, ImagesWithoutAValueAreCountedAndNeverBreakPairs) {
    Sample s = sample();
    for (StudyRow& row : s.records.rows) row.frame = -1;
    for (StudyRow& row : s.records.rows)
        if (row.scene == 0 && row.spp == 4 && row.seed == 2 && row.method == 0) row.metrics["ssim"] = std::nan("");
    const StudySummaries all = summarize(s.study, s.plan, s.records);
    const auto summary = [&](size_t scene, size_t method) {
        return *std::find_if(all.metrics.begin(), all.metrics.end(), [&](const StudySummary& one) {
            return one.scene == scene && one.method == method && one.spp == 4 && one.metric == "ssim";
        });
    };
    EXPECT_EQ(summary(0, 0).interval.count, 2);
    EXPECT_EQ(summary(0, 0).missing, 1);
    EXPECT_EQ(summary(0, 1).interval.count, 3);
    EXPECT_EQ(summary(kAllScenes, 0).missing, 1) << "a mean over scenes is no mean without one of them";
    for (const StudyRanking& ranking : all.rankings)
        if (ranking.scene == 0 && ranking.spp == 4 && ranking.metric == "ssim") {
            EXPECT_EQ(ranking.places.back().toBest.count, 2) << "two complete pairs";
            EXPECT_NEAR(ranking.places.back().toBest.mean, -0.1 / 4, 1e-12) << "of images that belong together";
        }
    const auto json = resultsJson(s.study, s.plan, s.records, all);
    int64_t missing = 0;
    for (const auto& entry : json["summary"]) missing += entry["missing"].get<int64_t>();
    EXPECT_EQ(missing, 2);
}

void writeColour(const std::filesystem::path& path, const Image& image) {
    ExrLayers layers;
    layers.add("", "RGB", image);
    writeExr(path, layers);
}

/// Four seeds of an image that is too bright by 0.2, with noise of variance 0.01; in one of them a pixel is NaN. That
/// pixel counts in none, or it would look like one without error.
TEST(Results, BiasAndVarianceLeaveOutPixelsThatAreNotFinite) {
    TemporaryFolder folder;
    const Extent2 extent{48, 32};
    const Study study = parseStudy(
        R"({"version": 1, "scenes": ["cornell"], "seeds": [1, 2, 3, 4], "metrics": ["mse"], "entries": [{"module": "none"}]})",
        "t.json", "");
    StudyRecords records;
    records.references.push_back({0, 0, "r.exr", 0, {{"mse", 0}}, {}, 0, {}});
    Image reference(extent, 3);
    reference.fill(0.5f);
    writeColour(folder / "r.exr", reference);
    uint64_t drawn = 0;
    for (int seed = 1; seed <= 4; ++seed) {
        Image image = reference;
        for (size_t i = 0; i < image.size(); ++i)
            image.data()[i] += 0.2f + 0.1f * (mixBits(drawn++) & 1 ? 1.0f : -1.0f);
        // Pixels with a large error, and NaN in one channel of one seed.
        for (int channel = 0; channel < 3; ++channel) image.at(channel, 5, 5) = 100;
        if (seed == 2) image.at(1, 5, 5) = NAN;
        if (seed == 3) image.at(0, 7, 7) = INFINITY;
        StudyRow row;
        row.frame = 0, row.seed = seed, row.image = folder / (std::to_string(seed) + ".exr"),
        row.reference = folder / "r.exr";
        row.nonFinitePixels = seed == 2 || seed == 3;
        writeColour(row.image, image);
        records.rows.push_back(row);
    }
    const StudySummaries all = summarize(study, planStudy(study), records);
    ASSERT_EQ(all.biases.size(), 1u);
    const StudyBias& bias = all.biases[0];
    EXPECT_EQ(bias.pixelsLeftOut, 2);
    EXPECT_EQ(bias.pixels, 48 * 32 - 2);
    EXPECT_NEAR(bias.parts.squaredBias, 0.04, 0.002);
    EXPECT_NEAR(bias.parts.variance, 0.01, 0.0005);
    EXPECT_NEAR(bias.biasShare, 0.8, 0.02);
    EXPECT_TRUE(bias.variance.known() && bias.share.known());
    EXPECT_TRUE(bias.variance.low < 0.01 && 0.01 < bias.variance.high);
    EXPECT_TRUE(bias.squaredBias.low < 0.04 && 0.04 < bias.squaredBias.high);
    ASSERT_EQ(all.nonFinite.size(), 1u);
    EXPECT_EQ(all.nonFinite[0].pixels, 2);
    EXPECT_EQ(all.nonFinite[0].images, 2);
    EXPECT_EQ(all.nonFinite[0].allImages, 4);
}

/// A stage's worth is a paired difference; those without a stage are not ranked among the entries.
TEST(Results, AblationsArePairedDifferences) {
    const Study study = parseStudy(R"({"version": 1, "scenes": ["cornell"], "seeds": [1, 2, 3], "metrics": ["mse"],
        "entries": [{"name": "a", "module": "accumulate"}, {"name": "b", "module": "none"}],
        "ablations": [{"entry": "a", "stages": [{"name": "limit", "set": {"limit": true}}]}]})",
                                   "t.json", "");
    const StudyPlan plan = planStudy(study);
    ASSERT_EQ(plan.methods.size(), 3u);
    StudyRecords records;
    for (size_t method = 0; method < 3; ++method)
        for (const int seed : study.seeds) {
            StudyRow row;
            row.method = method, row.seed = seed;
            row.metrics["mse"] = 10 * seed + (method == 2 ? 0.5 + 0.01 * seed : 0) + (method == 1 ? 100 : 0);
            records.rows.push_back(row);
        }
    const StudySummaries all = summarize(study, plan, records);
    ASSERT_EQ(all.stages.size(), 1u);
    EXPECT_EQ(all.stages[0].without, 2u);
    EXPECT_NEAR(all.stages[0].difference.mean, 0.52, 1e-12);
    EXPECT_TRUE(all.stages[0].difference.excludesZero()) << "though the seeds differ by more";
    EXPECT_FALSE(all.stages[0].wholeMean.low > 10);
    ASSERT_EQ(all.rankings.size(), 1u);
    EXPECT_EQ(all.rankings[0].places.size(), 2u);
}

/// Claims are judged by paired differences to the bound; "a" has about half the error of "b", whatever the sample
/// count.
TEST(Results, ClaimsHoldOrNotOrNobodyKnows) {
    Sample s = sample();
    for (StudyRow& row : s.records.rows) row.frame = -1;
    const auto claim = [&](const std::string& entry, const std::string& metric, const std::vector<std::string>& against,
                           double bound, bool atLeast = false) {
        StudyCheck check;
        check.entry = entry, check.metric = metric, check.against = against, check.bound = bound,
        check.atLeast = atLeast;
        s.study.checks = {check};
        return checkClaims(s.study, s.plan, s.records, {});
    };
    using Verdict = StudyCheckResult::Verdict;
    const std::string b = s.study.entries[1].name;
    std::vector<StudyCheckResult> results = claim("a", "mse", {b}, 0.6);
    ASSERT_EQ(results.size(), 2u * 3) << "each scene, each sample count";
    for (const StudyCheckResult& result : results) {
        EXPECT_EQ(result.verdict, Verdict::Holds);
        EXPECT_NEAR(result.ratio.mean, 1.02 / 2.02, 1e-9);
        EXPECT_TRUE(result.ratio.low < result.ratio.mean && result.ratio.mean < result.ratio.high);
        EXPECT_EQ(result.against, b);
    }
    EXPECT_EQ(claim("a", "mse", {b}, 0.4)[0].verdict, Verdict::Fails);
    EXPECT_EQ(claim("a", "mse", {b}, 0.5)[0].verdict, Verdict::FailsWithinNoise) << "0.005, 0.010 and 0.015 beyond";
    EXPECT_FALSE(claim("a", "mse", {b}, 0.5)[0].asClaimed());
    EXPECT_EQ(claim("a", "mse", {b}, 1.02 / 2.02 + 1e-9)[0].verdict, Verdict::WithinNoise)
        << "right at the bound nothing tells";
    EXPECT_EQ(claim("a", "ssim", {b}, 1, true)[0].verdict, Verdict::Holds);
    EXPECT_EQ(claim(b, "ssim", {"a"}, 1, true)[0].verdict, Verdict::Fails);
    EXPECT_EQ(claim("a", "mse", {}, 1.1)[0].verdict, Verdict::Holds) << "a bound of its own";
    EXPECT_EQ(claim("a", "mse", {}, 0.9)[0].verdict, Verdict::Fails);
    s.study.checks[0].onAverage = true;
    EXPECT_EQ(checkClaims(s.study, s.plan, s.records, {}).size(), 3u);
    s.records.rows[0].corrected.clear(), s.records.rows[0].metrics["mse"] = NAN;
    results = claim("a", "mse", {b}, 0.6);
    EXPECT_EQ(std::count_if(results.begin(), results.end(),
                            [](const auto& result) { return result.verdict == Verdict::Unknown; }),
              1)
        << "the seeds that are left do not speak for all";
    for (StudyRow& row : s.records.rows) row.corrected.clear(), row.metrics["mse"] = NAN;
    EXPECT_EQ(claim("a", "mse", {b}, 2)[0].verdict, Verdict::Unknown) << "no value holds nothing";
}

/// What a claim is held against and does not run at that sample count makes it unknown; it never goes unsaid.
TEST(Results, AClaimAgainstWhatDidNotRunIsUnknown) {
    Sample s = sample();
    for (StudyRow& row : s.records.rows) row.frame = -1;
    StudyCheck check;
    check.entry = "a", check.metric = "mse", check.against = {s.study.entries[1].name}, check.bound = 5;
    s.study.checks = {check};
    std::erase_if(s.records.rows, [](const StudyRow& row) { return row.method == 1 && row.spp == 4; });
    const std::vector<StudyCheckResult> results = checkClaims(s.study, s.plan, s.records, {});
    ASSERT_EQ(results.size(), 2u * 3);
    for (const StudyCheckResult& result : results)
        EXPECT_EQ(result.verdict,
                  result.spp == 4 ? StudyCheckResult::Verdict::Unknown : StudyCheckResult::Verdict::Holds);
    s.study.checks[0].metric = "flip";
    for (const StudyCheckResult& result : checkClaims(s.study, s.plan, s.records, {}))
        EXPECT_FALSE(result.asClaimed()) << "nothing was judged";
}

TEST(Results, JsonHoldsNoNumberThatJsonCannot) {
    Sample s = sample();
    for (StudyRow& row : s.records.rows) row.frame = -1;
    s.records.rows[0].metrics["ssim"] = std::nan("");
    const auto json = resultsJson(s.study, s.plan, s.records, summarize(s.study, s.plan, s.records));
    EXPECT_TRUE(json["rows"][0]["metrics"]["ssim"].is_null());
    EXPECT_EQ(json["rows"][0]["frame"], "sequence");
    EXPECT_EQ(json["rows"].size(), 36u);
    EXPECT_EQ(json.dump().find("nan"), std::string::npos);
}

TEST(Results, ReferenceNoiseIsTakenOffMeansOfSquares) {
    EXPECT_TRUE(isSquaredError("mse") && isSquaredError("rmse") && isSquaredError("relmse"));
    EXPECT_FALSE(isSquaredError("flip") || isSquaredError("ssim") || isSquaredError("mae"));
    EXPECT_DOUBLE_EQ(withoutReferenceNoise("mse", 5, 2), 3);
    EXPECT_DOUBLE_EQ(withoutReferenceNoise("rmse", 5, 3), 4);
    EXPECT_DOUBLE_EQ(withoutReferenceNoise("mse", 1, 2), -1) << "unbiased";
    EXPECT_DOUBLE_EQ(withoutReferenceNoise("rmse", 1, 2), 0);
}

TEST(Report, Base64IsTheStandards) {
    const auto encoded = [](const std::string& text) { return base64({text.begin(), text.end()}); };
    EXPECT_EQ(encoded(""), "");
    EXPECT_EQ(encoded("f"), "Zg==");
    EXPECT_EQ(encoded("fo"), "Zm8=");
    EXPECT_EQ(encoded("foo"), "Zm9v");
    EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
    EXPECT_EQ(encoded("\xff\xfe"), "//4=");
}

}  // namespace
}  // namespace lumi::test
