#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "base/files.h"
#include "study/study_file.h"
#include "support/temporary_folder.h"

namespace lumi::test {
namespace {
namespace fs = std::filesystem;

const fs::path kStudies = fs::path(LUMISCOPE_SOURCE_DIR) / "scenes" / "studies";

/// What python3-jsonschema says of each document: '1' valid, '0' not; empty without it.
std::string verdicts(const std::vector<fs::path>& documents) {
    std::string command =
        "python3 -c '"
        "import json,sys,jsonschema\n"
        "s=json.load(open(sys.argv[1]));c=jsonschema.validators.validator_for(s);c.check_schema(s)\n"
        "print(*(int(c(s).is_valid(json.load(open(f)))) for f in sys.argv[2:]),sep=\"\")' 2>/dev/null " +
        (kStudies / "study.schema.json").string();
    for (const fs::path& document : documents) command += ' ' + document.string();
    std::string answer;
    if (FILE* pipe = popen(command.c_str(), "r")) {
        for (int c = fgetc(pipe); c != EOF && c != '\n'; c = fgetc(pipe)) answer += static_cast<char>(c);
        pclose(pipe);
    }
    return answer;
}

TEST(StudySchema, TheShippedFileIsTheGeneratedOne) {
    const fs::path shipped = kStudies / "study.schema.json";
    if (std::getenv("LUMISCOPE_UPDATE_SCHEMA")) writeFileAtomically(shipped, std::string_view(studyFileSchema()));
    ASSERT_TRUE(readTextFile(shipped) == studyFileSchema())
        << "a declaration changed; run this test once with LUMISCOPE_UPDATE_SCHEMA=1 and commit " << shipped;
}

TEST(StudySchema, TakesWhatTheParserTakes) {
    if (std::system("python3 -c 'import jsonschema' 2>/dev/null") != 0) GTEST_SKIP() << "python3-jsonschema is not installed";
    std::vector<fs::path> good;
    for (const StudyListing& study : listStudies()) good.push_back(study.path);
    EXPECT_EQ(verdicts(good), std::string(good.size(), '1'));

    TemporaryFolder folder;
    const std::string head = R"({"version": 1, "scenes": ["cornell"], "entries": [{"module": "none"}], )";
    std::vector<fs::path> bad;
    for (const char* member :
         {R"("seds": [1]})", R"("spp": 0})", R"("metrics": ["rsme"]})", R"("size": [16]})", R"("reference": {"spp": 48}})",
          R"("presets": {"quick": {"title": "x"}}})"}) {
        EXPECT_THROW(parseStudy(head + member, "t.json", ""), std::exception) << member;
        bad.push_back(folder / ("bad-" + std::to_string(bad.size()) + ".json"));
        writeFileAtomically(bad.back(), std::string_view(head + member));
    }
    EXPECT_EQ(verdicts(bad), std::string(bad.size(), '0'));
}

}  // namespace
}  // namespace lumi::test
