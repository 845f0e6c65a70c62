#include "scene/procedural/generators.h"

namespace lumi {
namespace {

constexpr uint32_t kFabric = 0, kCushions = 1, kLegs = 2;

/// An upholstered seat: plinth, arms, back, loose seat and back cushions, turned wooden legs.
class Sofa final : public Procedural {
public:
    void describe(ParameterVisitor& v) override {
        describeLength(v, "width", width_, "Width", 0.6, 4, "Over the arms");
        describeLength(v, "depth", depth_, "Depth", 0.6, 1.5, "From the back to the front of the seat");
        describeLength(v, "height", height_, "Height", 0.6, 1.2, "Of the back");
        describeCount(v, "seats", seats_, "Seats", 1, 6, "Cushions side by side");
        describeSeed(v, seed_);
    }

    ProceduralResult build() const override {
        Dice dice(seed_);
        Mesh mesh;
        const float legHeight = 0.13f, plinthTop = 0.30f, armWidth = 0.17f, armTop = 0.60f;
        const float backDepth = 0.20f, zBack = -depth_ / 2;
        append(mesh, roundedBox({width_, plinthTop - legHeight, depth_}, 0.025f, 4), kFabric,
               placed({0, (plinthTop + legHeight) / 2, 0}));
        for (const float side : {-1.0f, 1.0f}) {
            Mesh arm = cushionBox({armWidth, armTop - legHeight, depth_}, 0.06f, 0.0f, 5, 6);
            append(mesh, arm, kFabric, placed({side * (width_ - armWidth) / 2, (armTop + legHeight) / 2, 0}));
        }
        append(mesh, roundedBox({width_ - 2 * armWidth, height_ - plinthTop, backDepth}, 0.06f, 5), kFabric,
               placed({0, (height_ + plinthTop) / 2, zBack + backDepth / 2}));
        addCushions(mesh, dice, armWidth, plinthTop, zBack + backDepth);
        const Profile leg = {{0, 0}, {0.016f, 0, true}, {0.026f, legHeight + 0.01f, true}, {0, legHeight + 0.01f}};
        for (const float x : {-1.0f, 1.0f})
            for (const float z : {-1.0f, 1.0f})
                append(mesh, lathe(leg, 20), kLegs, placed({x * (width_ / 2 - 0.08f), 0, z * (depth_ / 2 - 0.08f)}));
        return onePart(std::move(mesh), {opaqueSlot("fabric", {0.35f, 0.36f, 0.38f}, 0.9f),
                                         opaqueSlot("cushions", {0.40f, 0.41f, 0.43f}, 0.9f),
                                         opaqueSlot("legs", {0.16f, 0.08f, 0.04f}, 0.35f)});
    }

private:
    void addCushions(Mesh& mesh, Dice& dice, float armWidth, float plinthTop, float zFront) const {
        const float inner = width_ - 2 * armWidth, each = inner / static_cast<float>(seats_);
        const float seatDepth = depth_ / 2 - zFront + 0.015f;
        for (int i = 0; i < seats_; ++i) {
            const float x = -inner / 2 + each * (static_cast<float>(i) + 0.5f);
            append(mesh, cushionBox({each - 0.012f, 0.15f, seatDepth}, 0.045f, 0.025f, 4, 14), kCushions,
                   placed({x, plinthTop + 0.073f, zFront + seatDepth / 2}, {0, dice.range(-0.5f, 0.5f), 0}));
            const float backHeight = height_ - plinthTop - 0.06f;
            append(mesh, cushionBox({each - 0.02f, 0.15f, backHeight}, 0.05f, 0.045f, 4, 14), kCushions,
                   placed({x, plinthTop + 0.135f + backHeight / 2, zFront + 0.085f},
                          {90 - dice.range(8, 11), dice.range(-1.5f, 1.5f), 0}));
        }
    }

    float width_ = 2.1f, depth_ = 0.92f, height_ = 0.80f;
    int seats_ = 2, seed_ = 1;
};

/// A loose square pillow, standing on its edge along X and leaning back.
class Pillow final : public Procedural {
public:
    void describe(ParameterVisitor& v) override {
        describeLength(v, "width", size_, "Width", 0.2, 1, "Of its side");
        describeLength(v, "thickness", thickness_, "Thickness", 0.05, 0.4, "At the middle");
        describeSeed(v, seed_);
    }

    ProceduralResult build() const override {
        const float half = size_ / 2, swell = thickness_ / 2;
        const auto seed = static_cast<uint32_t>(seed_);
        const auto side = [&](float sign) {
            return gridSurface(
                28, 28,
                [&](float u, float v) {
                    float x = 2 * u - 1, y = 2 * v - 1;
                    const float fill = std::pow(std::max(0.0f, (1 - x * x) * (1 - y * y)), 0.42f);
                    const float pull = 0.09f * (1 - y * y) * x, rise = 0.09f * (1 - x * x) * y;
                    const float crease = 0.06f * valueNoise(Vec3(3 * x, 3 * y, sign * 2), seed) * fill;
                    return Vec3(half * (x - pull), half + half * (y - rise), sign * swell * fill * (1 + crease));
                },
                Vec2(size_));
        };
        Mesh mesh = side(1), back = side(-1);
        turnInsideOut(back);
        append(mesh, back);
        smoothNormals(mesh, 75);
        return onePart(std::move(mesh), {opaqueSlot("surface", {0.7f, 0.35f, 0.12f}, 0.85f)});
    }

private:
    float size_ = 0.45f, thickness_ = 0.16f;
    int seed_ = 1;
};

}  // namespace

std::unique_ptr<Procedural> makeSofa() { return std::make_unique<Sofa>(); }
std::unique_ptr<Procedural> makePillow() { return std::make_unique<Pillow>(); }

}  // namespace lumi
