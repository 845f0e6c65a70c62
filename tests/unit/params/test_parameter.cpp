#include <gtest/gtest.h>

#include <limits>

#include "support/expect_error.h"
#include "support/parameter_object.h"

namespace lumi {
namespace {
using test::expectError;
using test::Filter;
using test::SampleObject;

ParameterInfo infoOf(SampleObject& object, const std::string& id) {
    for (const ParameterInfo& info : listParameters(object.describer()))
        if (info.id == id) return info;
    ADD_FAILURE() << id;
    return {};
}

TEST(Parameters, AreListedInOrderWithTheirDeclaration) {
    SampleObject object;
    std::vector<std::string> ids;
    for (const ParameterInfo& info : listParameters(object.describer())) ids.push_back(info.id);
    EXPECT_EQ(ids,
              (std::vector<std::string>{"alpha", "levels", "inner", "temporal", "filter", "tint", "offset", "file"}));
    const ParameterInfo alpha = infoOf(object, "alpha");
    EXPECT_EQ(alpha.type, ParameterType::Number);
    EXPECT_EQ(alpha.scale, Scale::Log);
    EXPECT_EQ(alpha.min, 0.01);
    EXPECT_EQ(alpha.help, "Weight of the new value (eq. 1)");
    EXPECT_EQ(std::get<float>(alpha.value), 0.2f);
    EXPECT_EQ(infoOf(object, "levels").unit, "px");
    EXPECT_EQ(infoOf(object, "levels").redo, Redo::History);
    EXPECT_EQ(infoOf(object, "filter").options, (std::vector<std::string>{"box", "gauss", "catmull-rom"}));
    EXPECT_EQ(std::get<std::string>(infoOf(object, "filter").value), "gauss");
    EXPECT_EQ(infoOf(object, "tint").max, 2);
}

TEST(Parameters, WhenNests) {
    SampleObject object;
    EXPECT_TRUE(infoOf(object, "levels").active);
    EXPECT_FALSE(infoOf(object, "inner").active);
    object.filter = Filter::Box;
    EXPECT_TRUE(infoOf(object, "inner").active);
    object.temporal = false;
    EXPECT_FALSE(infoOf(object, "levels").active);
    EXPECT_FALSE(infoOf(object, "inner").active);
    EXPECT_TRUE(infoOf(object, "alpha").active);
    // Values are set whatever the condition.
    setParameter(object.describer(), "inner", 4.0f);
    EXPECT_EQ(object.inner, 4);
}

TEST(Parameters, AreSetAndReadBack) {
    SampleObject object;
    const Describe describe = object.describer();
    EXPECT_EQ(setParameter(describe, "alpha", 0.5f), Redo::Filter);
    EXPECT_EQ(setParameter(describe, "alpha", 1), Redo::Filter);  // an int for a number
    EXPECT_EQ(object.alpha, 1);
    EXPECT_EQ(setParameter(describe, "levels", 8), Redo::History);
    EXPECT_EQ(setParameter(describe, "temporal", false), Redo::History);
    EXPECT_EQ(setParameter(describe, "filter", std::string("catmull-rom")), Redo::Filter);
    EXPECT_EQ(setParameter(describe, "tint", Vec3(0, 1, 2)), Redo::Samples);
    EXPECT_EQ(setParameter(describe, "offset", Vec3(-5)), Redo::Samples);
    EXPECT_EQ(setParameter(describe, "file", std::string("x.exr")), Redo::Build);
    EXPECT_EQ(object.levels, 8);
    EXPECT_FALSE(object.temporal);
    EXPECT_EQ(object.filter, Filter::Catmull);
    EXPECT_EQ(object.tint, Vec3(0, 1, 2));
    EXPECT_EQ(object.file, "x.exr");
    EXPECT_EQ(std::get<Vec3>(getParameter(describe, "offset")), Vec3(-5));
}

TEST(Parameters, RangesAreClosedAndRefuse) {
    SampleObject object;
    const Describe describe = object.describer();
    setParameter(describe, "alpha", 0.01f);  // above 0.01 as a double
    setParameter(describe, "levels", 1);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const float bad : {0.0f, 1.01f, -kInfinity, kInfinity, nan})
        expectError(ErrorKind::Usage, [&] { setParameter(describe, "alpha", bad, "--set"); },
                    {"--set", "\"alpha\"", "0.01 to 1"});
    expectError(ErrorKind::Usage, [&] { setParameter(describe, "levels", 9); }, {"1 to 8", "found 9"});
    expectError(ErrorKind::Usage, [&] { setParameter(describe, "tint", Vec3(0, 0, 2.1f)); }, {"0 to 2"});
    expectError(ErrorKind::Usage, [&] { setParameter(describe, "offset", Vec3(0, nan, 0)); }, {"offset"});
    EXPECT_EQ(object.alpha, 0.01f);
    EXPECT_EQ(object.tint, Vec3(1, 0.5f, 0));
}

TEST(Parameters, WrongTypesAndNamesAreRefused) {
    SampleObject object;
    const Describe describe = object.describer();
    expectError(ErrorKind::Usage, [&] { setParameter(describe, "levels", 2.0f); }, {"whole number"});
    expectError(ErrorKind::Usage, [&] { setParameter(describe, "temporal", 1); }, {"true or false"});
    expectError(ErrorKind::Usage, [&] { setParameter(describe, "filter", std::string("tent")); },
                {"box, gauss, catmull-rom", "tent"});
    expectError(ErrorKind::Usage, [&] { setParameter(describe, "filter", 1); }, {"filter"});
    expectError(ErrorKind::Usage, [&] { setParameter(describe, "tint", 1.0f); }, {"three numbers"});
    expectError(ErrorKind::Usage, [&] { setParameter(describe, "file", 1); }, {"text"});
    expectError(ErrorKind::Usage, [&] { setParameter(describe, "alfa", 1.0f, "x.json:1:2"); },
                {"x.json:1:2", "alfa", "\"alpha\""});
    expectError(ErrorKind::Usage, [&] { getParameter(describe, "qqqqqqqqqq"); }, {"one of alpha"});
}

TEST(Parameters, TextFormsRoundTrip) {
    SampleObject object;
    object.alpha = 0.1f;
    object.tint = Vec3(0.1f, 1.0f / 3, 1e-7f);
    object.offset = Vec3(-1234.567f, 0, 1e6f);
    for (const ParameterInfo& info : listParameters(object.describer()))
        EXPECT_EQ(parseParameter(info, formatParameter(info.value)), info.value) << info.id;
    EXPECT_EQ(formatParameter(0.1f), "0.1");
    EXPECT_EQ(formatParameter(true), "true");
    EXPECT_EQ(formatParameter(Vec3(1, 0.5f, 0)), "1,0.5,0");
}

TEST(Parameters, TextFormsOfTheCommandLine) {
    SampleObject object;
    const auto parse = [&](const char* id, const char* text) {
        return parseParameter(infoOf(object, id), text, "--set");
    };
    for (const char* yes : {"true", "on", "1"}) EXPECT_EQ(parse("temporal", yes), ParameterValue(true));
    for (const char* no : {"false", "off", "0"}) EXPECT_EQ(parse("temporal", no), ParameterValue(false));
    EXPECT_EQ(parse("levels", "7"), ParameterValue(7));
    EXPECT_EQ(parse("levels", "+7"), ParameterValue(7));
    EXPECT_EQ(parse("levels", "-7"), ParameterValue(-7));
    EXPECT_EQ(parse("levels", "1e3"), ParameterValue(1000));
    EXPECT_EQ(parse("levels", "16777217"), ParameterValue(16777217));
    EXPECT_EQ(parse("alpha", "+.5"), ParameterValue(0.5f));
    EXPECT_EQ(parse("tint", "0.5"), ParameterValue(Vec3(0.5f)));
    EXPECT_EQ(parse("tint", "1,0,0.25"), ParameterValue(Vec3(1, 0, 0.25f)));
    EXPECT_EQ(parse("file", "a,b"), ParameterValue(std::string("a,b")));
    const std::pair<const char*, const char*> bad[] = {
        {"alpha", ""},    {"alpha", "x"},      {"alpha", "1x"},    {"alpha", "nan"}, {"alpha", "+-1"},
        {"alpha", "inf"}, {"levels", "1.5"},   {"levels", "9e9"},  {"levels", "7 "}, {"temporal", "ja"},
        {"tint", "1,2"},  {"tint", "1,2,3,4"}, {"tint", "1,2,3,"}, {"tint", ""}};
    for (const auto& [id, text] : bad)
        expectError(ErrorKind::Usage, [&, i = id, t = text] { parse(i, t); }, {"--set", id});
}

}  // namespace
}  // namespace lumi
