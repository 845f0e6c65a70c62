// Curves and maps against known points.
#include <gtest/gtest.h>

#include "frame/colour_maps.h"
#include "frame/display.h"
#include "support/expect_error.h"

namespace lumi {
namespace {

const ToneCurve kCurves[] = {ToneCurve::Clamp, ToneCurve::Reinhard, ToneCurve::Aces, ToneCurve::AgX};

TEST(ToneCurve, StaysInRangeAndRisesForGreys) {
    for (const ToneCurve curve : kCurves) {
        float last = -1;
        for (float x = 1e-6f; x < 1e9f; x *= 1.3f) {
            const Vec3 y = toneMap(Vec3(x), curve);
            for (int c = 0; c < 3; ++c) {
                EXPECT_GE(y[c], 0) << x;
                EXPECT_LE(y[c], 1) << x;
            }
            EXPECT_GE(y.y, last - 2e-4f) << x;
            last = y.y;
        }
        EXPECT_GT(last, 0.98f) << static_cast<int>(curve);
        EXPECT_LT(maxComponent(toneMap(Vec3(0), curve)), 2e-3f);
        EXPECT_EQ(toneMap(Vec3(-1), curve), toneMap(Vec3(0), curve));
    }
}

TEST(ToneCurve, GreysStayGrey) {
    for (const ToneCurve curve : kCurves)
        for (const float x : {0.01f, 0.18f, 1.0f, 4.0f}) {
            const Vec3 y = toneMap(Vec3(x), curve);
            EXPECT_NEAR(y.x, y.y, 0.003f);
            EXPECT_NEAR(y.z, y.y, 0.003f);
        }
}

TEST(ToneCurve, ClosedForms) {
    EXPECT_EQ(toneMap({0.25f, 0.5f, 3}, ToneCurve::Clamp), Vec3(0.25f, 0.5f, 1));
    EXPECT_NEAR(toneMap(Vec3(1), ToneCurve::Reinhard).x, 0.5f, 1e-6f);
    EXPECT_NEAR(toneMap(Vec3(3), ToneCurve::Reinhard).y, 0.75f, 1e-6f);
    // Hill's rational at x = 0.3 (0.18 times the exposure factor; the matrices' rows sum to 1 within 1e-4).
    const double x = 0.3, aces = (x * (x + 0.0245786) - 0.000090537) / (x * (0.983729 * x + 0.4329510) + 0.238081);
    EXPECT_NEAR(toneMap(Vec3(0.18f), ToneCurve::Aces).y, aces, 1e-4);
    // Middle grey stays middle grey under all but Reinhard's plain form.
    EXPECT_NEAR(toneMap(Vec3(0.18f), ToneCurve::AgX).y, 0.18f, 0.04f);
    EXPECT_NEAR(toneMap(Vec3(0.18f), ToneCurve::Aces).y, 0.2f, 0.03f);
}

TEST(ToneCurve, AgxMatricesAreInverse) {
    // Very saturated light loses its saturation as it grows: no channel is left behind.
    const Vec3 red = toneMap(Vec3(500, 0, 0), ToneCurve::AgX);
    EXPECT_GT(red.y, 0.2f);
    EXPECT_GT(toneMap(Vec3(0.2f, 0.01f, 0.01f), ToneCurve::AgX).x,
              2 * toneMap(Vec3(0.2f, 0.01f, 0.01f), ToneCurve::AgX).y);
}

void expectColour(const std::string& map, float t, const Vec3& wanted, float tolerance) {
    const Vec3 found = colourMapValue(map, t);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], wanted[c], tolerance) << map << " at " << t << ", channel " << c;
}

TEST(ColourMaps, KnownPoints) {
    expectColour("viridis", 0, {0.267f, 0.005f, 0.329f}, 0.02f);
    expectColour("viridis", 0.5f, {0.128f, 0.567f, 0.551f}, 0.02f);
    expectColour("viridis", 1, {0.993f, 0.906f, 0.144f}, 0.03f);
    expectColour("magma", 0, {0.001f, 0.0005f, 0.014f}, 0.02f);
    expectColour("magma", 0.5f, {0.716f, 0.215f, 0.475f}, 0.03f);
    expectColour("magma", 1, {0.987f, 0.991f, 0.750f}, 0.03f);
    // The published fit of turbo is loose at its ends.
    expectColour("turbo", 0, {0.190f, 0.072f, 0.232f}, 0.13f);
    expectColour("turbo", 0.5f, {0.644f, 0.990f, 0.234f}, 0.09f);
    expectColour("turbo", 1, {0.480f, 0.016f, 0.011f}, 0.09f);
    expectColour("gray", 0.25f, Vec3(0.25f), 1e-6f);
    expectColour("signed", 0.5f, Vec3(0.97f), 1e-3f);
    EXPECT_GT(colourMapValue("signed", 0).z, colourMapValue("signed", 0).x);
    EXPECT_GT(colourMapValue("signed", 1).x, colourMapValue("signed", 1).z);
    expectColour("cyclic", 0, colourMapValue("cyclic", 1), 1e-5f);
}

TEST(ColourMaps, LightnessOfSequentialMapsRises) {
    for (const char* map : {"viridis", "magma", "gray"}) {
        float last = -1;
        for (int i = 0; i <= 64; ++i) {
            const float light = luminance(colourMapValue(map, static_cast<float>(i) / 64));
            EXPECT_GT(light, last - 0.004f) << map << ' ' << i;
            last = light;
        }
    }
}

TEST(ColourMaps, TablesAreSmoothAndComplete) {
    for (const std::string map : colourMapNames()) {
        const std::vector<uint32_t>& table = colourTable(map);
        ASSERT_EQ(table.size(), static_cast<size_t>(kColourTableSize));
        if (map == "ids") continue;
        for (size_t i = 1; i < table.size(); ++i)
            for (int shift = 0; shift < 24; shift += 8)
                EXPECT_LE(
                    std::abs(static_cast<int>(table[i] >> shift & 255) - static_cast<int>(table[i - 1] >> shift & 255)),
                    4)
                    << map << ' ' << i;
    }
    test::expectError(ErrorKind::Usage, [] { colourMapValue("jet", 0.5f); }, {"jet", "viridis"});
    EXPECT_EQ(colourMapValue("gray", kInfinity), Vec3(1));
    EXPECT_EQ(colourMapValue("gray", std::numeric_limits<float>::quiet_NaN()), Vec3(0));
}

}  // namespace
}  // namespace lumi
