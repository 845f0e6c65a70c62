#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "params/json.h"
#include "support/expect_error.h"
#include "support/parameter_object.h"

namespace lumi {
namespace {
using nlohmann::json;
using test::expectError;
using test::SampleObject;

TEST(ParameterJson, ValuesRoundTripThroughText) {
    SampleObject object;
    object.alpha = 0.1f;
    object.tint = Vec3(0.1f, 1.0f / 3, 1e-7f);
    for (const ParameterInfo& info : listParameters(object.describer()))
        EXPECT_EQ(parameterFromJson(info, json::parse(toJson(info.value).dump())), info.value) << info.id;
}

TEST(ParameterJson, NumbersAreWrittenAsPeopleWriteThem) {
    EXPECT_EQ(toJson(ParameterValue(0.1f)).dump(), "0.1");
    EXPECT_EQ(toJson(ParameterValue(Vec3(0.2f, 1, 0))).dump(), "[0.2,1.0,0.0]");
    EXPECT_EQ(toJson(ParameterValue(3)).dump(), "3");
    EXPECT_EQ(toJson(ParameterValue(true)).dump(), "true");
    // Every float comes back as it was.
    for (uint32_t i = 0; i < 20000; ++i) {
        const float value = std::ldexp(static_cast<float>(i * 2654435761u), static_cast<int>(i % 120) - 90);
        EXPECT_EQ(json::parse(toJson(ParameterValue(value)).dump()).get<float>(), value);
    }
}

TEST(ParameterJson, WrongTypesAreRefused) {
    SampleObject object;
    const std::vector<ParameterInfo> list = listParameters(object.describer());
    const auto info = [&](const std::string& id) {
        return *std::find_if(list.begin(), list.end(), [&](const ParameterInfo& i) { return i.id == id; });
    };
    const std::pair<const char*, const char*> bad[] = {{"alpha", "\"1\""},
                                                       {"alpha", "true"},
                                                       {"levels", "1.5"},
                                                       {"levels", "4294967297"},
                                                       {"levels", "-99999999999"},
                                                       {"levels", "18446744073709551615"},
                                                       {"temporal", "1"},
                                                       {"filter", "1"},
                                                       {"tint", "[1,2]"},
                                                       {"tint", "[1,2,null]"},
                                                       {"tint", "1"},
                                                       {"file", "[]"},
                                                       {"file", "null"}};
    for (const auto& [id, text] : bad)
        expectError(ErrorKind::Usage,
                    [&, i = id, t = text] { parameterFromJson(info(i), json::parse(t), "scene.json:3:4"); },
                    {"scene.json:3:4", id});
    EXPECT_EQ(parameterFromJson(info("alpha"), json::parse("1")), ParameterValue(1.0f));
}

TEST(ParameterJson, DescriptionsSayAll) {
    SampleObject object;
    const std::vector<ParameterInfo> list = listParameters(object.describer());
    const json alpha = toJson(list[0]);
    EXPECT_EQ(
        alpha,
        json::parse(R"-({"id": "alpha", "title": "Alpha", "type": "number", "default": 0.2, "min": 0.01, "max": 1.0,
        "scale": "log", "help": "Weight of the new value (eq. 1)", "redo": "filter"})-"));
    const json filter = toJson(list[4]);
    EXPECT_EQ(filter["options"], json::parse(R"(["box", "gauss", "catmull-rom"])"));
    EXPECT_EQ(filter["default"], "gauss");
    EXPECT_EQ(toJson(list[1])["unit"], "px");
}

}  // namespace
}  // namespace lumi
