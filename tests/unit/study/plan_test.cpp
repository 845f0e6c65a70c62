#include "study/plan.h"

#include <gtest/gtest.h>

#include <set>

#include "study/study_file.h"

namespace lumi::test {
namespace {

Study parse(const std::string& members) { return parseStudy("{\"version\": 1, " + members + "}", "t.json", ""); }

std::vector<std::string> ids(const StudyPlan& plan) {
    std::vector<std::string> all;
    for (const StudyJob& job : plan.jobs) all.push_back(job.id);
    return all;
}

TEST(Plan, GoesSceneBySceneThenSamplesThenSeeds) {
    const StudyPlan plan = planStudy(parse(R"("scenes": ["cornell", "room"], "spp": [4, 1], "seeds": [2, 1],
        "entries": [{"module": "none"}])"));
    EXPECT_EQ(ids(plan), (std::vector<std::string>{"cornell-spp1-seed2-a", "cornell-spp1-seed1-a",
                                                   "cornell-spp4-seed2-a", "cornell-spp4-seed1-a", "room-spp1-seed2-a",
                                                   "room-spp1-seed1-a", "room-spp4-seed2-a", "room-spp4-seed1-a"}));
}

/// Screen-space methods of one frame see identical samples; another sampler, or another wish for the camera's offsets,
/// means other samples.
TEST(Plan, MethodsShareSamplesWhereTheyCan) {
    const StudyPlan plan = planStudy(parse(R"("scenes": ["cornell"], "entries": [
        {"name": "all", "module": "none"}, {"name": "direct", "module": "none", "set": {"component": "direct"}},
        {"name": "mean", "module": "accumulate"},
        {"name": "halton", "module": "none", "set": {"sampler.kind": "halton"}}])"));
    ASSERT_EQ(plan.jobs.size(), 3u);
    EXPECT_EQ(plan.jobs[0].methods, (std::vector<size_t>{0, 1}));
    EXPECT_EQ(plan.jobs[1].methods, (std::vector<size_t>{2}));
    EXPECT_EQ(plan.jobs[2].methods, (std::vector<size_t>{3}));
    EXPECT_EQ(plan.jobs[2].sampling.at(0).text, "halton");
    EXPECT_TRUE(plan.jobs[0].sampling.empty());
}

TEST(Plan, ASweepIsEveryCombination) {
    const Study study =
        parse(R"("scenes": ["cornell"], "entries": [{"name": "a", "module": "accumulate"}, {"module": "none"}],
        "sweep": {"axes": {"max-samples": [1, 2], "path.max-depth": [3, 4]}, "entries": ["a"]})");
    const StudyPlan plan = planStudy(study);
    ASSERT_EQ(plan.methods.size(), 5u);
    EXPECT_EQ(plan.methods[1].name, "a [max-samples=1, path.max-depth=4]");
    EXPECT_EQ(plan.methods[2].coordinates, (std::vector<std::string>{"2", "3"}));
    EXPECT_TRUE(plan.methods[4].coordinates.empty());
    std::set<std::string> instances;
    for (const StudyMethod& method : plan.methods) instances.insert(method.instance);
    EXPECT_EQ(instances.size(), plan.methods.size());
    // Two path depths and the raw frame's own offsets: three sets of samples.
    EXPECT_EQ(plan.jobs.size(), 3u);
}

TEST(Plan, WhatASweepTakesAlongFollowsItsAxis) {
    const StudyPlan plan = planStudy(parse(R"("scenes": ["cornell"], "entries": [{"name": "a", "module": "accumulate"}],
        "sweep": {"axes": {"path.max-depth": [3, 4, 5]}, "with": {"max-samples": [7, 8, 7], "render.exposure": [0, 1, 2]}})"));
    ASSERT_EQ(plan.methods.size(), 3u);
    EXPECT_EQ(plan.methods[1].name, "a [path.max-depth=4]");
    EXPECT_EQ(plan.methods[1].coordinates, (std::vector<std::string>{"4"}));
    const auto valueOf = [&](size_t method, const std::string& id) {
        std::string text;
        for (const StudyValue& value : plan.methods[method].set)
            if (value.id == id) text = value.text;
        return text;
    };
    for (size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(valueOf(i, "path.max-depth"), std::to_string(3 + i));
        EXPECT_EQ(valueOf(i, "max-samples"), i == 1 ? "8" : "7");
        EXPECT_EQ(valueOf(i, "render.exposure"), std::to_string(i));
    }
}

TEST(Plan, TuningComesBeforeWhatItTunes) {
    const StudyPlan plan =
        planStudy(parse(R"("scenes": ["cornell"], "frames": {"range": [0, 4]}, "tuning": {"frame": 1},
        "entries": [{"name": "a", "module": "accumulate", "tune": {"max-samples": [1, 2]}}])"));
    ASSERT_EQ(plan.jobs.size(), 2u);
    EXPECT_EQ(plan.jobs[0].kind, StudyJob::Kind::Tune);
    EXPECT_EQ(plan.jobs[0].id, "cornell-spp1-tune-a");
    EXPECT_EQ(plan.jobs[1].kind, StudyJob::Kind::Measure);
}

/// A stage that is off stays off, whatever tuning chose; where it changes no samples it shares the whole method's.
TEST(Plan, AblationsAreTheEntryWithoutEachStage) {
    const StudyPlan plan =
        planStudy(parse(R"("scenes": ["cornell"], "frames": {"range": [0, 4]}, "tuning": {"frame": 1},
        "entries": [{"name": "a", "module": "accumulate", "set": {"limit": true}, "tune": {"max-samples": [1, 2]}}, {"module": "none"}],
        "ablations": [{"entry": "a", "stages": [{"name": "mean", "set": {"max-samples": 1}}, {"name": "depth", "set": {"path.max-depth": 2}}]}])"));
    ASSERT_EQ(plan.methods.size(), 4u);
    EXPECT_EQ(plan.methods[2].name, "a without mean");
    EXPECT_EQ(plan.methods[2].whole, 0u);
    EXPECT_EQ(plan.methods[2].fixed, std::vector<std::string>{"max-samples"});
    EXPECT_EQ(plan.methods[2].set.front().id, "limit") << "the entry's own values stay";
    EXPECT_FALSE(plan.methods[0].whole);
    // The whole and the one without the mean share samples; the other depth does not.
    EXPECT_EQ(plan.jobs[1].methods, (std::vector<size_t>{0, 2}));
    EXPECT_EQ(plan.jobs.back().methods, std::vector<size_t>{3});
}

TEST(Plan, AnEntryMayHaveSampleCountsOfItsOwn) {
    const StudyPlan plan = planStudy(parse(R"("scenes": ["cornell"], "spp": [1],
        "entries": [{"name": "a", "module": "none"}, {"name": "b", "module": "none", "spp": [1, 8]}])"));
    ASSERT_EQ(plan.jobs.size(), 2u);
    EXPECT_EQ(plan.jobs[0].methods.size(), 2u);
    EXPECT_EQ(plan.jobs[1].spp, 8);
    EXPECT_EQ(plan.jobs[1].methods, std::vector<size_t>{1});
}

/// What changes a job's result changes its definition, and nothing else does.
TEST(Plan, DefinitionsHoldWhatResultsDependOn) {
    const auto definition = [](const std::string& member, const std::string& set = "") {
        return planStudy(parse("\"scenes\": [\"cornell\"], \"entries\": [{\"module\": \"none\", \"set\": {" + set +
                               "}}], " + member))
            .jobs.at(0)
            .definition;
    };
    const std::string plain = definition("\"title\": \"a\"");
    EXPECT_EQ(plain, definition("\"title\": \"another title\""));
    EXPECT_EQ(plain, definition("\"figures\": [{\"name\": \"f\", \"crops\": [{\"box\": [0, 0, 1, 1]}]}]"));
    EXPECT_EQ(plain, definition("\"pictures\": {\"error-map\": \"mse\"}"));
    std::set<std::string> all{plain};
    for (const char* member :
         {"\"size\": [8, 8]", "\"seeds\": [3]", "\"spp\": [2]", "\"reference\": {\"spp\": 64}",
          "\"metrics\": [\"mse\"]", "\"set\": {\"path.max-depth\": 2}",
          "\"reference\": {\"set\": {\"path.max-depth\": 2}}", "\"frames\": {\"range\": [0, 3]}",
          "\"frames\": {\"range\": [0, 3], \"still\": true}", "\"frames\": {\"range\": [0, 3], \"fps\": 24}",
          "\"metric-settings\": {\"relmse-epsilon\": 0.01}", "\"metric-settings\": {\"hdr-flip-exposures\": [0, 2]}",
          "\"frames\": {\"range\": [0, 3], \"step\": {\"frame\": 1, \"set\": {\"light.lamp.power\": 2}}}"})
        EXPECT_TRUE(all.insert(definition(member)).second) << member;
    EXPECT_TRUE(all.insert(definition("\"title\": \"a\"", "\"component\": \"direct\"")).second);
    EXPECT_TRUE(all.insert(definition("\"title\": \"a\"", "\"path.clamp\": true")).second);
}

TEST(Plan, ReferencesFollowWhatDefinesTheImage) {
    for (const char* id : {"material.floor.roughness", "light.lamp.power", "path.max-depth", "camera.aperture", "time"})
        EXPECT_TRUE(definesImage(id)) << id;
    for (const char* id :
         {"sampler.kind", "path.clamp", "path.regularize", "path.strategy", "camera.jitter", "render.spp"})
        EXPECT_FALSE(definesImage(id)) << id;
}

}  // namespace
}  // namespace lumi::test
