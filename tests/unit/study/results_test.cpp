#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "study/report.h"
#include "study/results.h"
#include "study/run_job.h"
#include "study/study_file.h"

namespace lumi::test {
namespace {

/// Records of two methods on two scenes with three seeds, made up: "b" is worse by one everywhere.
struct Sample {
    Study study = parseStudy(R"({"version": 1, "scenes": ["cornell", "room"], "spp": [1, 4, 16], "seeds": [1, 2, 3], "metrics": ["mse", "ssim"],
        "entries": [{"name": "a", "module": "none"}, {"name": "b", "module": "none"}]})", "t.json", "");
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
        EXPECT_NEAR(std::abs(ranking.places.back().toBest.mean), (ranking.metric == "mse" ? 1.0 : 0.1) / ranking.spp, 1e-12);
    }
    EXPECT_EQ(all.rankings.size(), 3u * 3 * 2) << "two scenes and all together, three sample counts, two metrics";
    for (const StudySlope& slope : all.slopes) EXPECT_NEAR(slope.slope.mean, -1, 1e-9);
    EXPECT_EQ(all.slopes.size(), 4u) << "errors only, a scene and method each";
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
