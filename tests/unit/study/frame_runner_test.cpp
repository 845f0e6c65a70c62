#include "study/frame_runner.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "study/records.h"
#include "study/study_file.h"
#include "study/temporal_metrics.h"
#include "support/sky_file.h"
#include "support/temporary_folder.h"
#include "support/tiny_scene.h"

namespace lumi::test {
namespace {

/// A study of the tiny scene, flown through, and what its jobs need.
struct SmallStudy {
    explicit SmallStudy(const std::string& set, const std::string& frames = "")
        : study(parseStudy(R"({"version": 1, "scenes": ["tiny"], "frames": {"range": [0, 4], "measure": [3])" + frames +
                               R"(},
        "seeds": [1, 2], "size": [16, 12], "reference": {"spp": 32}, "metrics": ["mse", "temporal_reprojected"],
        "entries": [{"module": "none"}], "set": {)" +
                               set + "}}",
                           "s.json", "")) {}

    JobContext context() {
        return {study,
                plan,
                scene,
                references,
                log,
                {},
                [](size_t, int) { return std::vector<StudyValue>{}; },
                [](double, double, const std::string&) {}};
    }
    /// Of frame 2 of a job's run.
    std::shared_ptr<const Signals> geometryOf(size_t job, FrameOutput* frame = nullptr) {
        const JobContext own = context();
        FrameRunner runner(own, plan.jobs[job], methodsOf(own, plan.jobs[job]));
        for (int i = 0; i < 2; ++i) runner.advance({});
        const FrameOutput drawn = runner.advance(temporalSignals());
        if (frame) *frame = drawn;
        return runner.geometry();
    }

    Study study;
    StudyPlan plan = planStudy(study);
    MessageLog log;
    std::shared_ptr<const Scene> scene = movingScene();
    StudyReferences references{study, "", log};
};

const char* kLens = R"("camera.jitter": "per-pixel", "camera.aperture": 0.3, "camera.shutter": 0.9)";

// A frame's own motion is that of its samples: of the lens, the open shutter and the seed.
TEST(FrameRunner, MotionIsTheReferencesWhateverTheSamples) {
    SmallStudy first(kLens), second(kLens);
    ASSERT_EQ(first.plan.jobs.size(), 2u);
    FrameOutput a, b;
    const auto one = first.geometryOf(0, &a), other = second.geometryOf(1, &b);
    EXPECT_NE((*a.signals)[Signal::Motion], (*b.signals)[Signal::Motion]) << "or there would be nothing to tell";
    EXPECT_EQ((*one)[Signal::Motion], (*other)[Signal::Motion]);
    EXPECT_EQ((*one)[Signal::Depth], (*other)[Signal::Depth]);
    EXPECT_EQ(first.geometryOf(1), one) << "and traced once for all jobs of a scene";
    SmallStudy sharp(R"("camera.jitter": "none")");
    FrameOutput still;
    EXPECT_EQ((*sharp.geometryOf(0, &still))[Signal::Motion], (*one)[Signal::Motion]) << "it is what a pinhole sees";
    EXPECT_EQ((*still.signals)[Signal::Motion], (*one)[Signal::Motion]);
    bool moves = false;
    for (size_t i = 0; i < (*one)[Signal::Motion].size(); ++i) moves = moves || (*one)[Signal::Motion].data()[i] != 0;
    EXPECT_TRUE(moves);
}

TEST(FrameRunner, FramesWithoutABuildCountAsNone) {
    SmallStudy small("", R"(, "still": true)");
    const JobContext context = small.context();
    TemporaryFolder folder;
    nlohmann::json times;
    const nlohmann::json result = runMeasureJob(context, small.plan.jobs[0], folder / "job", folder.path(), times);
    EXPECT_EQ(times.at("build_ms"), 0) << "nothing is built after the first frame";
    times["build_ms"] = 1000;
    StudyRecords records;
    records.add(small.plan, small.plan.jobs[0], result, times, folder / "job", folder.path());
    ASSERT_EQ(records.times.size(), 1u);
    EXPECT_EQ(records.times[0].buildMs, 1000);
    EXPECT_GE(records.times[0].frameMs(), 1000) << "a build is a part of the frame";
}

TEST(FrameRunner, AJobDependsOnWhatItsSkyHolds) {
    TemporaryFolder folder;
    const auto write = [&](float radiance) { writeSky(folder / "sky.exr", radiance); };
    SmallStudy small("\"environment.file\": \"" + (folder / "sky.exr").string() + "\"");
    const JobContext context = small.context();
    write(1);
    const std::string before = checkJobValues(context, small.plan.jobs[0]);
    EXPECT_EQ(checkJobValues(context, small.plan.jobs[0]), before);
    write(2);
    EXPECT_NE(checkJobValues(context, small.plan.jobs[0]), before);
}

}  // namespace
}  // namespace lumi::test
