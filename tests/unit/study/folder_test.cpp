#include "study/study_folder.h"

#include <gtest/gtest.h>

#include <fstream>

#include "base/files.h"
#include "study/study_clock.h"
#include "study/study_file.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace lumi::test {
namespace {

Study named(const std::string& name, const std::string& members = "") {
    return parseStudy(
        R"({"version": 1, "scenes": ["cornell", "room"], "entries": [{"module": "none"}], "seeds": [1, 2], "presets": {"quick": {}})" +
            members + "}",
        name + ".json", "");
}

TEST(StudyFolder, BelongsToOneStudy) {
    TemporaryFolder folder;
    const std::filesystem::path out = folder / "out";
    { const StudyFolder first(named("one"), out); }
    { const StudyFolder again(named("one", ", \"title\": \"edited\""), out); }
    expectError(ErrorKind::Usage, [&] { const StudyFolder other(named("two"), out); },
                {"holds the study \"one\"", "another folder for \"two\""});
    Study quick = named("one");
    quick.preset = "quick";
    expectError(ErrorKind::Usage, [&] { const StudyFolder other(quick, out); },
                {"holds the study \"one\"", "preset \"quick\""});
    const StudyFolder held(named("one"), out);
    expectError(ErrorKind::Usage, [&] { const StudyFolder second(named("one"), out); },
                {"another study runs in this folder"});
}

TEST(StudyFolder, StrangeFilesAreNeverTouched) {
    TemporaryFolder folder;
    writeFileAtomically(folder / "thesis.tmp", std::string_view("mine"));
    expectError(ErrorKind::Usage, [&] { const StudyFolder other(named("one"), folder.path()); },
                {"holds \"thesis.tmp\"", "an empty folder"});
    EXPECT_FALSE(std::filesystem::exists(folder / "study.json"));
    std::ofstream(folder / "file") << "no folder";
    expectError(ErrorKind::Usage, [&] { const StudyFolder other(named("one"), folder / "file"); }, {"cannot be made"});
}

TEST(StudyFolder, KeepsWhatIsNamed) {
    TemporaryFolder folder;
    {
        StudyFolder first(named("one"), folder / "out");
        for (const char* name :
             {"jobs/a/job.json", "jobs/a/x.exr.tmp", "jobs/b/job.json", "references/r.exr", "references/old.exr",
              "figures/f.png", "figures/f.png.1.2.tmp", "tables/t.tex", "results.csv"})
            writeFileAtomically(first.path() / name, std::string_view("x"));
        first.note({"references/r.exr", "references/old.exr", "figures/f.png", "tables/t.tex"});
    }
    // What somebody put beside them, a paper made of the tables for one.
    for (const char* name : {"tables/all.pdf", "figures/mine.png", "figures/mine.png.1.2.tmp", "references/mine/r.exr"})
        writeFileAtomically(folder / "out" / name, std::string_view("mine"));
    StudyFolder out(named("one"), folder / "out");
    out.keepOnly({"a"}, {"references/r.exr", "figures/f.png"});
    for (const char* kept : {"jobs/a/job.json", "references/r.exr", "figures/f.png", "results.csv", "study.json",
                             "tables/all.pdf", "figures/mine.png", "figures/mine.png.1.2.tmp", "references/mine/r.exr"})
        EXPECT_TRUE(std::filesystem::exists(out.path() / kept)) << kept;
    for (const char* gone :
         {"jobs/b", "jobs/a/x.exr.tmp", "references/old.exr", "figures/f.png.1.2.tmp", "tables/t.tex"})
        EXPECT_FALSE(std::filesystem::exists(out.path() / gone)) << gone;
}

/// Whatever the label lists, nothing outside the three folders is removed.
TEST(StudyFolder, TheLabelCannotNameOtherFiles) {
    TemporaryFolder folder;
    writeFileAtomically(folder / "precious", std::string_view("mine"));
    writeFileAtomically(
        folder / "out" / "study.json",
        std::string_view(
            R"({"study": "one", "preset": "", "files": ["../precious", "tables/..", "references/../../precious", 7]})"));
    StudyFolder out(named("one"), folder / "out");
    out.keepOnly({}, {});
    EXPECT_TRUE(std::filesystem::exists(folder / "precious") && std::filesystem::exists(out.path() / "study.json"));
}

/// Two scenes, two seeds, a reference each: frames take 1 s in the first scene and 3 s in the second, references 10 s.
TEST(StudyClock, LearnsHowLongThingsTake) {
    const Study study = named("one", ", \"reference\": {\"spp\": 64}");
    const StudyPlan plan = planStudy(study);
    ASSERT_EQ(plan.jobs.size(), 4u);
    StudyClock clock(study, plan);
    EXPECT_LT(clock.leftS(0), 0) << "nothing is known before anything is done";
    double now = 0, last = 0;
    const auto run = [&](size_t job, double framesS, double referencesS) {
        clock.begin(job, now);
        for (int i = 1; i <= 10; ++i) {
            clock.at(1, 6.4 * i, now += referencesS / 10);
            EXPECT_GE(clock.fraction(), last) << "a bar never goes back";
            last = clock.fraction();
        }
        now += framesS;
        clock.at(1, 64, now);
        clock.end(now);
    };
    run(0, 1, 10);
    EXPECT_NEAR(clock.leftS(now), 1 + (1 + 10) + 1, 0.5) << "the second scene is thought to be like the first";
    EXPECT_NEAR(clock.fraction(), 11.0 / 24, 0.05);
    run(1, 1, 0);
    run(2, 3, 10);
    EXPECT_NEAR(clock.leftS(now), 3, 0.01) << "a job like one that was run takes as long";
    run(3, 3, 0);
    EXPECT_DOUBLE_EQ(clock.leftS(now), 0);
    EXPECT_DOUBLE_EQ(clock.fraction(), 1);
}

TEST(StudyClock, WhatIsThereTakesNoTime) {
    const Study study = named("one", ", \"reference\": {\"spp\": 64}");
    const StudyPlan plan = planStudy(study);
    StudyClock clock(study, plan);
    for (size_t job = 0; job < 3; ++job) clock.found(job);
    clock.begin(3, 0);
    clock.at(0.5, 0, 1);
    EXPECT_NEAR(clock.leftS(1), 1, 0.01) << "half of the frames of the only job took a second";
    EXPECT_GT(clock.fraction(), 0.7);
}

}  // namespace
}  // namespace lumi::test
