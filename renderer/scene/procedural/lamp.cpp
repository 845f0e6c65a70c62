#include "scene/procedural/generators.h"

namespace lumi {
namespace {

constexpr uint32_t kMetal = 0, kShade = 1, kBulb = 2;

/// A lamp on a weighted foot: stem, conical cloth shade open above and below, a bulb inside.
class Lamp final : public Procedural {
public:
    void describe(ParameterVisitor& v) override {
        describeLength(v, "height", height_, "Height", 0.2, 3, "Of the shade's upper edge");
        describeLength(v, "shade-radius", radius_, "Shade radius", 0.05, 1, "At the shade's lower edge");
        describeLength(v, "shade-height", shadeHeight_, "Shade height", 0.05, 1, "From edge to edge");
        describeLength(v, "bulb-radius", bulb_, "Bulb radius", 0.01, 0.2, "Of the glowing ball");
    }

    ProceduralResult build() const override {
        Mesh mesh;
        const float y1 = height_, y0 = height_ - shadeHeight_, r0 = radius_, r1 = radius_ * 0.72f,
                    foot = radius_ * 0.62f;
        append(mesh,
               lathe(smoothProfile({{0, 0},
                                    {foot, 0, true},
                                    {foot, 0.012f},
                                    {foot * 0.96f, 0.02f},
                                    {foot * 0.4f, 0.028f},
                                    {0.016f, 0.045f},
                                    {0.011f, 0.075f, true},
                                    {0.011f, y0 + shadeHeight_ * 0.35f, true},
                                    {0, y0 + shadeHeight_ * 0.35f}},
                                   4),
                     48),
               kMetal);
        // The shade is a thin wall with rolled edges.
        const float t = 0.0015f;
        append(mesh,
               lathe({{r0, y0, true}, {r1, y1, true}, {r1 - t, y1, true}, {r0 - t, y0, true}, {r0, y0, true}}, 96),
               kShade);
        append(mesh, ring(r0 - t, y0, 0.0035f), kShade);
        append(mesh, ring(r1 - t, y1, 0.0035f), kShade);
        // Three spokes carry the shade on the stem.
        const float carrier = y0 + shadeHeight_ * 0.3f, rc = r0 + (r1 - r0) * 0.3f - t;
        for (int i = 0; i < 3; ++i) {
            const float a = 2 * kPi * static_cast<float>(i) / 3;
            append(
                mesh,
                tube({Vec3(0, carrier, 0), Vec3(rc * std::cos(a), carrier, rc * std::sin(a))}, {0.0025f, 0.0025f}, 8),
                kMetal);
        }
        const Vec3 centre(0, y0 + shadeHeight_ * 0.35f + bulb_ * 1.1f, 0);
        Profile ball;
        for (int k = 0; k <= 16; ++k) {
            const float a = kPi * static_cast<float>(k) / 16;
            ball.push_back({k == 0 || k == 16 ? 0 : bulb_ * std::sin(a), -bulb_ * std::cos(a)});
        }
        append(mesh, lathe(ball, 24), kBulb, placed(centre));
        MaterialSlot bulb = opaqueSlot("bulb", {0.9f, 0.9f, 0.9f}, 0.5f),
                     shade = opaqueSlot("shade", {0.8f, 0.72f, 0.58f}, 0.9f);
        bulb.fallback.emission = {110, 78, 45};
        shade.fallback.emission = {1.5f, 1.0f, 0.55f};
        return onePart(std::move(mesh), {opaqueSlot("metal", {0.72f, 0.52f, 0.26f}, 0.25f, 1), shade, bulb});
    }

private:
    static Mesh ring(float radius, float y, float thick) {
        Profile section;
        for (int k = 0; k <= 8; ++k) {
            const float a = 2 * kPi * static_cast<float>(k % 8) / 8;
            section.push_back({radius + thick * std::cos(a), y + thick * std::sin(a)});
        }
        return lathe(section, 96);
    }

    float height_ = 1.62f, radius_ = 0.24f, shadeHeight_ = 0.32f, bulb_ = 0.045f;
};

}  // namespace

std::unique_ptr<Procedural> makeFloorLamp() { return std::make_unique<Lamp>(); }

}  // namespace lumi
