#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <vector>

#include "base/files.h"
#include "study/study_file.h"
#include "support/schema_verdicts.h"
#include "support/temporary_folder.h"

namespace lumi::test {
namespace {
namespace fs = std::filesystem;

const fs::path kStudies = fs::path(LUMISCOPE_SOURCE_DIR) / "scenes" / "studies";
const fs::path kSchema = kStudies / "study.schema.json";

TEST(StudySchema, TheShippedFileIsTheGeneratedOne) {
    if (std::getenv("LUMISCOPE_UPDATE_SCHEMA")) writeFileAtomically(kSchema, std::string_view(studyFileSchema()));
    ASSERT_TRUE(readTextFile(kSchema) == studyFileSchema())
        << "a declaration changed; run this test once with LUMISCOPE_UPDATE_SCHEMA=1 and commit " << kSchema;
}

TEST(StudySchema, TakesWhatTheParserTakes) {
    if (!haveSchemaValidator()) GTEST_SKIP() << "python3-jsonschema is not installed";
    std::vector<fs::path> good;
    for (const StudyListing& study : listStudies()) good.push_back(study.path);
    EXPECT_EQ(schemaVerdicts(kSchema, good), std::string(good.size(), '1'));

    TemporaryFolder folder;
    const std::string head = R"({"version": 1, "scenes": ["cornell"], "entries": [{"module": "none"}], )";
    std::vector<fs::path> bad;
    for (const char* member : {R"("seds": [1]})", R"("spp": 0})", R"("metrics": ["rsme"]})", R"("size": [16]})",
                               R"("reference": {"spp": 48}})", R"("presets": {"quick": {"title": "x"}}})"}) {
        EXPECT_THROW(parseStudy(head + member, "t.json", ""), std::exception) << member;
        bad.push_back(folder / ("bad-" + std::to_string(bad.size()) + ".json"));
        writeFileAtomically(bad.back(), std::string_view(head + member));
    }
    EXPECT_EQ(schemaVerdicts(kSchema, bad), std::string(bad.size(), '0'));
}

}  // namespace
}  // namespace lumi::test
