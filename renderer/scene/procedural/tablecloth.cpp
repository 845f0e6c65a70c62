#include <algorithm>

#include "scene/procedural/generators.h"

namespace lumi {
namespace {

/// A cloth that lies on a table top at y = 0 and falls over its front edge (+Z) in folds, with loose creases where it
/// lies. uv in metres.
class Tablecloth final : public Procedural {
public:
    void describe(ParameterVisitor& v) override {
        describeLength(v, "width", width_, "Width", 0.2, 10, "Along X");
        describeLength(v, "depth", depth_, "Depth", 0.2, 10, "Of the part that lies");
        describeLength(v, "drop", drop_, "Drop", 0, 3, "Of the part that hangs");
        describeLength(v, "crease", crease_, "Crease", 0, 0.1, "Height of the creases on the table");
        describeLength(v, "calm", calm_, "Calm", 0, 10, "Width of the middle that lies flat, for things to stand on");
        v.number("folds", folds_,
                 {.label = "Folds", .min = 0, .max = 60, .help = "Across the hanging part", .redo = Redo::Build});
        describeSeed(v, seed_);
    }

    ProceduralResult build() const override {
        const float whole = depth_ + drop_;
        Mesh mesh = gridSurface(
            170, 140, [&](float u, float v) { return clothPoint(u, v * whole); }, Vec2(width_, whole));
        return onePart(std::move(mesh), {opaqueSlot("surface", {0.55f, 0.52f, 0.47f}, 0.9f)});
    }

private:
    /// `along` runs from the hem in front up and over the edge to the back.
    Vec3 clothPoint(float u, float along) const {
        const auto seed = static_cast<uint32_t>(seed_);
        const float x = (u - 0.5f) * width_, round = 0.018f, arc = 0.5f * kPi * round;
        const float s = along - drop_;  // beyond the edge, on the table
        const float phase = 2 * kPi * (u * folds_ + 0.5f * valueNoise(Vec3(u * folds_ * 0.5f, along * 2, 3), seed));
        if (s < 0) {
            const float hang = std::min(1.0f, -s / std::max(drop_, 1e-3f));
            const float out = 0.085f * std::pow(hang, 0.8f) * (0.75f + std::sin(phase)) *
                              (0.8f + 0.4f * valueNoise(Vec3(u * folds_, 1.5f, 0), seed + 5));
            return {x + 0.02f * hang * std::cos(phase), -round + s, depth_ / 2 + round + out};
        }
        if (s < arc) {
            const float a = s / round;
            return {x, -round + round * std::sin(a), depth_ / 2 + round * std::cos(a)};
        }
        const float z = depth_ / 2 - (s - arc);
        return {x, creaseHeight(x, z) * glm::smoothstep(0.0f, 0.08f, s - arc), z};
    }

    /// A few long ridges with soft flanks, and small rumples between.
    float creaseHeight(float x, float z) const {
        const auto seed = static_cast<uint32_t>(seed_);
        const Vec3 p(x, 0, z);
        const float warp = 0.25f * valueNoise(p * 2.6f, seed);
        const float ridgeA = 1 - std::abs(valueNoise(Vec3(x * 2.1f + z * 1.2f + warp, 0.5f, z * 0.7f), seed + 1));
        const float ridgeB = 1 - std::abs(valueNoise(Vec3(x * 0.9f, 4.5f, z * 2.3f - x * 1.1f + warp), seed + 2));
        const float rumple = 0.12f * valueNoise(p * 14.0f, seed + 3);
        const float ridges = std::pow(std::max(0.0f, ridgeA), 7) + 0.7f * std::pow(std::max(0.0f, ridgeB), 8);
        const float loose = glm::smoothstep(0.5f, 0.85f, 2 * std::abs(x) / std::max(calm_, 1e-3f));
        return crease_ * (loose * std::max(0.0f, ridges) + 0.25f * std::max(0.0f, rumple));
    }

    float width_ = 1.6f, depth_ = 0.9f, drop_ = 0.5f, crease_ = 0.01f, calm_ = 0.4f, folds_ = 7;
    int seed_ = 1;
};

}  // namespace

std::unique_ptr<Procedural> makeTablecloth() { return std::make_unique<Tablecloth>(); }

}  // namespace lumi
