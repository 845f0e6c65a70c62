#include "reconstruct/catalog.h"

#include <gtest/gtest.h>

#include <set>

#include "support/expect_error.h"

namespace lumi {
namespace {

TEST(Catalog, IdsAreKebabCaseAndUnique) {
    std::set<std::string> ids;
    for (const ModuleEntry& entry : moduleCatalog()) {
        EXPECT_TRUE(ids.insert(entry.id).second) << entry.id;
        EXPECT_EQ(std::string(entry.id).find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-"), std::string::npos);
        EXPECT_STRNE(entry.title, "");
    }
    EXPECT_TRUE(ids.count("none") && ids.count("accumulate"));
}

TEST(Catalog, AnInstanceIsItsModule) {
    EXPECT_STREQ(findModule("accumulate@b").id, "accumulate");
    test::expectError(ErrorKind::Usage, [] { findModule("acumulate", "--module"); },
                      {"--module", "acumulate", "\"accumulate\""});
}

TEST(Catalog, EveryParameterHasAKebabCaseIdAndHelp) {
    for (const ModuleEntry& entry : moduleCatalog()) {
        const auto module = entry.make();
        for (const ParameterInfo& info : listParameters([&](ParameterVisitor& v) { module->describe(v); })) {
            EXPECT_EQ(info.id.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-"), std::string::npos) << info.id;
            EXPECT_FALSE(info.help.empty()) << info.id;
            EXPECT_FALSE(info.label.empty()) << info.id;
        }
    }
}

}  // namespace
}  // namespace lumi
