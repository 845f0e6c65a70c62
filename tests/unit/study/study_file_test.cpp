#include "study/study_file.h"

#include <gtest/gtest.h>

#include "support/expect_error.h"

namespace lumi::test {
namespace {

Study parse(const std::string& text, const std::string& preset = "") {
    return parseStudy(text, "folder/t.json", preset);
}

/// A study whose one interesting member is `member`.
std::string withMember(const std::string& member, const std::string& entry = R"({"module": "none"})") {
    return "{\"version\": 1, \"scenes\": [\"cornell\"],\n \"entries\": [" + entry + "],\n " + member + "}";
}

void refused(const std::string& text, const std::initializer_list<std::string>& parts) {
    expectError(
        ErrorKind::BadInput, [&] { parse(text); }, parts);
}

TEST(StudyFile, TheLeastStudyHasDefaults) {
    const Study study = parse(withMember("\"title\": \"T\""));
    EXPECT_EQ(study.name, "t");
    EXPECT_EQ(study.title, "T");
    EXPECT_EQ(study.scenes.at(0).name, "cornell");
    EXPECT_EQ(study.entries.at(0).name, "none");
    EXPECT_EQ(study.spp, std::vector<int>{1});
    EXPECT_EQ(study.frames.measure, std::vector<int64_t>{0});
    EXPECT_EQ(study.metrics, std::vector<std::string>{"rmse"});
    EXPECT_EQ(study.reference.spp, 1024);
    EXPECT_EQ(study.digest.size(), 16u);
}

TEST(StudyFile, EverythingIsRead) {
    const Study study = parse(R"({"version": 1, "title": "All", "paper": "Schied17", "description": "D",
      "scenes": ["cornell", {"scene": "room", "name": "night", "optional": true, "set": {"camera.select": "main"}}],
      "set": {"path.max-depth": 3}, "size": [320, 180],
      "frames": {"range": [0, 64], "measure": [63, 40], "temporal": [20, 60], "still": true, "fps": 30,
                 "step": {"frame": 20, "set": {"light.lamp.power": 2}}},
      "spp": [1, 4], "seeds": [7, 8], "reference": {"spp": 64, "set": {"path.max-depth": 9}},
      "metrics": ["ssim", "mse", "lag"], "tuning": {"frame": 8, "metric": "mse", "seed": 5},
      "entries": [{"name": "a", "module": "accumulate", "set": {"limit": true, "path.clamp": false}, "tune": {"max-samples": [2, 4]}},
                  {"module": "none", "spp": 2}, {"name": "b", "module": "none", "known": {"far": 3}}],
      "sweep": {"axes": {"component": ["direct", "indirect"]}, "entries": ["none"]},
      "checks": [{"title": "C", "entry": "a", "metric": "mse", "against": ["b"], "at-most": 1.03, "on-average": true}],
      "metric-settings": {"relmse-epsilon": 0.01, "hdr-flip-exposures": [-2, 3]},
      "pairs": [{"entry": "a", "against": "none"}, {"entry": "a", "against": ["none", "b"]}],
      "statistics": [{"name": "far", "tap": "sampleCount", "of": {"percentile": 99}}, {"name": "rough", "metric": "relmse", "reference-spp": 64},
                     {"name": "rays", "title": "Rays", "rays": "camera"}, {"name": "each", "over": "rays", "under": "far"}],
      "ablations": [{"entry": "a", "stages": [{"name": "limit", "set": {"limit": false}}]}],
      "figures": [{"name": "f", "scene": "night", "frame": 63, "spp": 4, "input": "none", "entries": ["a"], "metric": "mse",
                   "crops": [{"name": "c", "box": [0.1, 0.2, 0.3, 0.4]}, {"box": [0, 0, 1, 1]}]}],
      "intervals": {"level": 0.9, "units": "frames-and-seeds", "method": "bootstrap"},
      "pictures": {"frames": [40], "spp": [4], "error-map": "relmse"}})");
    EXPECT_EQ(study.scenes[1].name, "night");
    EXPECT_TRUE(study.scenes[1].optional);
    EXPECT_EQ(study.scenes[1].set[0].id, "camera.select");
    EXPECT_EQ(study.frames.measure, (std::vector<int64_t>{40, 63}));
    EXPECT_EQ(study.frames.temporalBegin, 20);
    EXPECT_EQ(study.frames.temporalMeanFrom, 20) << "all of them";
    EXPECT_EQ(study.entries[0].set[0].text, "true");
    EXPECT_EQ(study.entries[0].tune[0].values, (std::vector<std::string>{"2", "4"}));
    EXPECT_EQ(study.entries[1].spp, std::vector<int>{2});
    EXPECT_EQ(study.sweep->axes[0].id, "component");
    EXPECT_EQ(study.tuning->seed, 5);
    EXPECT_EQ(study.checks.at(0).bound, 1.03);
    EXPECT_EQ(study.checks.at(0).against, std::vector<std::string>{"b"});
    EXPECT_TRUE(study.checks.at(0).onAverage && !study.checks.at(0).atLeast);
    EXPECT_EQ(study.pairs.at(1).against, (std::vector<std::string>{"none", "b"}));
    ASSERT_EQ(study.statistics.size(), 4u);
    EXPECT_EQ(study.statistics[0].of, StudyStatistic::Of::Percentile);
    EXPECT_EQ(study.statistics[0].value, 99);
    EXPECT_EQ(study.statistics[1].referenceSpp, 64);
    EXPECT_EQ(study.statistics[2].title, "Rays");
    EXPECT_EQ(study.statistics[3].under, "far");
    EXPECT_EQ(study.entries[2].known.at(0), std::pair(std::string("far"), 3.0));
    EXPECT_TRUE(study.measures("each") && !study.measures("nothing"));
    EXPECT_EQ(study.metricSettings.relMseEpsilon, 0.01);
    EXPECT_EQ(*study.metricSettings.flipExposures, FlipExposures::over(-2, 3));
    EXPECT_EQ(study.frames.step->frame, 20);
    EXPECT_EQ(study.temporalMetrics, std::vector<std::string>{"lag"});
    EXPECT_EQ(study.ablations.at(0).stages.at(0).set.at(0).text, "false");
    EXPECT_EQ(study.figures.at(0).crops.at(0).height, 0.4);
    EXPECT_EQ(study.figures.at(0).scene, "night");
    EXPECT_EQ(study.intervals.units, StudyIntervals::Units::FramesAndSeeds);
    EXPECT_EQ(study.intervals.method, StudyIntervals::Method::Bootstrap);
    EXPECT_EQ(study.pictures.errorMap, "relmse");
    EXPECT_EQ(study.reference.set[0].text, "9");
}

TEST(StudyFile, APresetTakesTheStudysPlace) {
    const std::string text = withMember(R"("reference": {"spp": 64, "set": {"path.max-depth": 2}}, "seeds": [1, 2],
      "presets": {"quick": {"reference": {"spp": 32}, "size": [16, 9]}, "paper": {"seeds": [1, 2, 3]}})");
    const Study quick = parse(text, "quick"), paper = parse(text, "paper"), none = parse(text);
    EXPECT_EQ(quick.reference.spp, 32);
    EXPECT_EQ(quick.reference.set.size(), 1u) << "objects are merged member by member";
    EXPECT_EQ(quick.size, (Extent2{16, 9}));
    EXPECT_EQ(paper.reference.spp, 64);
    EXPECT_EQ(paper.seeds.size(), 3u);
    EXPECT_EQ(none.size.width, 0);
    expectError(ErrorKind::Usage, [&] { parse(text, "qick"); }, {"has no preset \"qick\"", "--preset", "\"quick\""});
}

TEST(StudyFile, ErrorsNamePlaceAndNearestKey) {
    refused("[1]", {"folder/t.json:1:1", "is not a study file"});
    refused("{\"version\": 2}", {":1:13", "\"version\" is 2", "expected 1"});
    refused("{\"version\": 1}", {"\"study\" has no \"scenes\""});
    refused(withMember("\"seds\": [1]"), {"t.json:3:2", "unknown key \"seds\"", "\"seeds\""});
    refused(withMember("\"spp\": [0]"), {":3:10", "\"spp\" is 0", "from 1 to 65536"});
    refused(withMember("\"seeds\": [1, 1]"), {"has 1 twice", ":3:15"});
    refused(withMember("\"metrics\": [\"rsme\"]"), {"unknown metric \"rsme\"", "\"rmse\"", ":3:14"});
    refused(withMember("\"size\": [16]"), {"\"size\"", "[width, height]"});
    refused(withMember("\"frames\": {\"range\": [0, 4], \"measure\": [4]}"), {"\"measure\"", "frames from 0 to 3"});
    refused(withMember("\"frames\": {\"range\": [4, 4]}"), {"4"});
    refused(withMember("\"reference\": {\"spp\": 48}"), {"multiple of 32"});
    refused(withMember("\"scenes\": []"), {"stands twice"});
    refused(withMember("\"pairs\": [{\"entry\": \"nonne\", \"against\": \"none\"}]"),
            {"unknown entry \"nonne\"", "\"none\""});
    refused(withMember("\"presets\": {\"quick\": {\"title\": \"x\"}}"), {"a preset cannot change \"title\""});
    refused(withMember("\"presets\": {\"quick\": {\"spp\": 0}}"), {"\"spp\" is 0"});
}

TEST(StudyFile, ModuleParametersAreCheckedAgainstTheCatalogue) {
    const auto entry = [](const std::string& text) { return withMember("\"title\": \"\"", text); };
    refused(entry(R"({"module": "acumulate"})"), {"unknown module \"acumulate\"", "\"accumulate\"", ":2:25"});
    refused(entry(R"({"module": "accumulate", "set": {"limitt": true}})"),
            {"module \"accumulate\" has no parameter \"limitt\"", "\"limit\"", ":2:"});
    refused(entry(R"({"module": "accumulate", "set": {"temporal.taa-alpha": 0.5}})"),
            {"\"temporal.taa-alpha\" has no effect on an entry of module \"accumulate\"", ":2:"});
    refused(entry(R"({"module": "accumulate", "set": {"accumulate.limit": true}})"),
            {"\"accumulate.limit\" has no effect", "\"limit\"", ":2:"});
    refused(entry(R"({"module": "accumulate", "set": {"max-samples": -1}})"), {"max-samples", "-1", ":2:"});
    refused(entry(R"({"module": "accumulate", "tune": {"max-samples": [1, 2]}})"), {"nothing says on which frame"});
    refused(entry(R"({"module": "none"}, {"module": "none"})"), {"two entries are called \"none\""});
    refused(withMember(R"("sweep": {"axes": {"component": ["direct", "indrect"]}})"), {"indrect", ":3:"});
    refused(withMember(R"("sweep": {"axes": {}})"), {"one or two axes"});
    refused(withMember(R"("sweep": {"axes": {"path.max-depth": [1, 2]}, "with": {"render.exposure": [0]}})"),
            {"\"render.exposure\" has 1 values", "2, as many as \"path.max-depth\""});
    refused(
        withMember(
            R"("sweep": {"axes": {"path.max-depth": [1], "path.clamp": [true]}, "with": {"render.exposure": [0]}})"),
        {"a single axis beside it"});
    refused(withMember(R"("sweep": {"axes": {"path.max-depth": [1]}, "with": {"component": ["indrect"]}})"),
            {"indrect"});
    refused(withMember(R"("tuning": {"frame": 0}, "frames": {"range": [0, 2], "measure": [0]})"),
            {"a frame that is not measured"});
}

TEST(StudyFile, StepsAblationsAndFiguresAreChecked) {
    const std::string entries = R"({"module": "accumulate"}, {"module": "none"})";
    const auto member = [&](const std::string& text) { return withMember(text, entries); };
    refused(member(R"("metrics": ["lag"])"), {":3:13", "\"step\"", "\"still\""});
    refused(member(R"("frames": {"range": [0, 9], "step": {"frame": 0, "set": {"light.a.power": 1}}})"),
            {"\"frame\" is 0", "from 1 to 8"});
    refused(member(R"("frames": {"range": [0, 9], "step": {"frame": 2, "set": {"path.clamp": true}}})"),
            {":3:", "path.clamp", "converged image"});
    const auto stage = [&](const std::string& text) {
        return member("\"ablations\": [{\"entry\": \"accumulate\", \"stages\": [" + text + "]}]");
    };
    refused(stage(R"({"name": "a", "set": {"limitt": true}})"), {"limitt", "\"limit\"", ":3:"});
    refused(stage(R"({"name": "a", "set": {}})"), {"what switches the stage off"});
    refused(stage(R"({"name": "a", "set": {"limit": true}}, {"name": "a", "set": {"limit": true}})"),
            {"two stages are called \"a\""});
    refused(member(R"("ablations": [{"entry": "acumulate", "stages": []}])"), {"unknown entry", "\"accumulate\""});
    refused(
        member(
            R"("sweep": {"axes": {"path.max-depth": [1]}}, "ablations": [{"entry": "none", "stages": [{"name": "a", "set": {"path.clamp": true}}]}])"),
        {"an entry that is not swept"});
    const auto figure = [&](const std::string& text) {
        return member("\"figures\": [{\"name\": \"f\", " + text + "}]");
    };
    refused(figure(R"("crops": [{"box": [0.9, 0, 0.2, 0.1]}])"), {"\"box\"", "shares of the picture", ":3:"});
    refused(figure(R"("crops": [{"box": [0, 0, 1]}])"), {"\"box\""});
    refused(figure(R"("crops": [])"), {"one to six crops"});
    refused(figure(R"("crops": [{"box": [0, 0, 1, 1]}], "scene": "cornel")"),
            {"unknown scene \"cornel\"", "\"cornell\""});
    refused(figure(R"("crops": [{"box": [0, 0, 1, 1]}], "metric": "psnr2")"), {"unknown metric with a map"});
    refused(figure(R"("crops": [{"box": [0, 0, 1, 1]}], "frame": 3)"), {"\"frame\""});
    refused(member(R"("checks": [{"entry": "none", "metric": "rmse"}])"), {"either \"at-most\" or \"at-least\""});
    refused(member(R"("checks": [{"entry": "none", "metric": "ssim", "at-least": 1}])"),
            {"unknown metric of the study \"ssim\""});
    refused(member(R"("checks": [{"entry": "none", "metric": "rmse", "at-most": 1, "against": ["nonne"]}])"),
            {"unknown entry", "\"none\""});
    const std::string swept = R"("sweep": {"axes": {"limit": [true, false]}, "entries": ["accumulate"]}, )";
    refused(member(swept + R"("checks": [{"entry": "accumulate", "metric": "rmse", "at-most": 1}])"),
            {"\"entry\"", "an entry that is not swept", ":3:"});
    refused(
        member(swept + R"("checks": [{"entry": "none", "metric": "rmse", "against": ["accumulate"], "at-most": 1}])"),
        {"\"against\"", "an entry that is not swept"});
    refused(member(R"("metric-settings": {"relmse-epsilon": 0})"), {"\"relmse-epsilon\" is 0"});
    refused(member(R"("metric-settings": {"hdr-flip-exposures": [3, -2]})"),
            {"\"hdr-flip-exposures\"", "[start, stop]"});
    refused(
        member(
            R"("figures": [{"name": "a b", "crops": [{"box": [0,0,1,1]}]}, {"name": "a-b", "crops": [{"box": [0,0,1,1]}]}])"),
        {"two figures are called"});
    std::string many = R"({"module": "none"})";
    for (int i = 0; i < 8; ++i) many += ", {\"name\": \"e" + std::to_string(i) + "\", \"module\": \"none\"}";
    const std::string strip = R"("figures": [{"name": "f", "crops": [{"box": [0,0,1,1]}])";
    refused(withMember(strip + "}]", many), {"figure \"f\" would show 9 entries", "at most 8", ":3:"});
    EXPECT_EQ(parse(withMember(strip + R"(, "entries": ["none", "e7"]}])", many)).figures.at(0).entries.size(), 2u);
}

TEST(StudyFile, ScenesHaveFilesOfTheirOwn) {
    const auto scenes = [](const std::string& list) {
        return "{\"version\": 1, \"entries\": [{\"module\": \"none\"}], \"scenes\": [" + list + "]}";
    };
    refused(scenes(R"({"scene": "room", "name": "a b"}, {"scene": "room", "name": "a-b"})"),
            {"\"a b\" and \"a-b\"", "t.json:1:"});
    refused(scenes(R"({"scene": "room", "name": "all scenes"})"), {"cannot be called \"all scenes\""});
    refused(scenes(R"({"scene": "room", "name": "all"})"), {"cannot be called \"all\""});
    EXPECT_EQ(parse(scenes(R"({"scene": "room", "name": "a b"}, {"scene": "room", "name": "a-c"})")).scenes.size(), 2u);
}

/// The shape of a paper's table: scenes with parameters, one of which may be missing, baselines that are tuned on a
/// frame that is not measured, a fixed view's flicker, times of every phase at several budgets, claims, and stages
/// switched off.
TEST(StudyFile, CarriesAPapersTablesAndFigures) {
    const Study table = parse(R"({"version": 1, "title": "Table", "paper": "Schied17",
      "scenes": ["atrium", {"scene": "assets:no/Sponza.gltf", "name": "sponza", "optional": true, "set": {"camera.select": "hall"}},
                 {"scene": "room", "name": "room-720", "set": {"render.width": 1280, "render.height": 720}}],
      "set": {"sampler.kind": "halton", "sampler.halton-loop": 16, "path.max-depth": 2},
      "frames": {"range": [0, 33], "measure": [24, 28, 32]}, "seeds": [1, 2, 3], "tuning": {"frame": 16, "metric": "ssim", "seed": 77},
      "entries": [{"name": "svgf", "module": "svgf"}, {"name": "raw", "module": "none", "spp": [1, 2, 4]},
                  {"name": "eaw", "module": "eaw", "tune": {"sigma-color": [0.1, 0.4, 1]}},
                  {"name": "temporal", "module": "temporal"}],
      "checks": [{"entry": "svgf", "metric": "ssim", "against": ["raw", "eaw", "temporal"], "at-least": 1},
                 {"entry": "svgf", "metric": "rmse", "against": ["raw", "eaw", "temporal"], "at-most": 1.03},
                 {"entry": "svgf", "metric": "rmse", "against": ["raw", "eaw", "temporal"], "at-most": 1, "on-average": true}],
      "ablations": [{"entry": "svgf", "stages": [{"name": "variance prefilter", "set": {"variance-prefilter": false}}]}],
      "pairs": [{"entry": "svgf", "against": "raw"}],
      "metrics": ["rmse", "ssim", "cpbd", "temporal_reprojected"],
      "presets": {"quick": {"size": [480, 270], "reference": {"spp": 256}}, "paper": {"size": [1920, 1080], "reference": {"spp": 4096}}}})",
                              "paper");
    EXPECT_EQ(table.reference.spp, 4096);
    EXPECT_EQ(table.entries[1].spp, (std::vector<int>{1, 2, 4}));
    EXPECT_TRUE(table.scenes[1].optional);
    EXPECT_EQ(table.checks.size(), 3u);
    const Study flicker = parse(
        R"({"version": 1, "scenes": ["atrium"], "frames": {"range": [0, 60], "still": true, "temporal": [1, 60], "mean-from": 20},
      "entries": [{"name": "svgf", "module": "svgf"}, {"name": "plain", "module": "svgf", "set": {"color-alpha": 1, "moments-alpha": 1}}],
      "checks": [{"entry": "svgf", "metric": "temporal", "against": ["plain"], "at-most": 0.2}], "metrics": ["temporal"]})");
    EXPECT_EQ(flicker.frames.temporalBegin, 1);
    EXPECT_EQ(flicker.frames.temporalMeanFrom, 20);
    EXPECT_TRUE(flicker.frames.still);
}

TEST(StudyFile, BrokenJsonIsOneLineWithItsPlace) {
    for (const std::string text : {"", "{", "{\"version\": 1,", "\xff", "{\"version\": 1}}", "null"})
        expectError(ErrorKind::BadInput, [&] { parse(text); }, {"folder/t.json:1:"});
}

TEST(StudyFile, EveryShippedStudyIsGoodAtEveryPreset) {
    const std::vector<StudyListing> studies = listStudies();
    EXPECT_GE(studies.size(), 2u);
    for (const StudyListing& listing : studies) {
        EXPECT_NE(listing.title, listing.name) << listing.path;
        for (const std::string preset : {"quick", "paper", ""}) {
            const Study study = loadStudy(listing.path, preset);
            EXPECT_GE(study.seeds.size(), 3u) << listing.path << " at " << preset << ": the jackknife needs three";
            for (const StudyScene& scene : study.scenes)
                EXPECT_TRUE(scene.optional || !findStudyScene(study, scene).empty());
        }
    }
    expectError(ErrorKind::Usage, [] { findStudy("convergense"); }, {"unknown study", "\"convergence\""});
    expectError(ErrorKind::BadInput, [] { findStudy("no/such.json"); }, {"no such file"});
}

}  // namespace
}  // namespace lumi::test
