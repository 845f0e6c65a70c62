#include "scene/procedural/generators.h"

namespace lumi {
namespace {

/// Cloth that hangs from a rod along X at the top: pleats that are tight above, wander and open below. The hem is on
/// y = 0. With `gather` it is drawn together at `gather-height`, as a curtain is by its tie.
class Drape final : public Procedural {
public:
    void describe(ParameterVisitor& v) override {
        describeLength(v, "width", width_, "Width", 0.1, 20, "At the rod");
        describeLength(v, "height", height_, "Height", 0.1, 30, "From hem to rod");
        describeLength(v, "depth", depth_, "Depth", 0, 1, "Of the folds, from crest to crest");
        v.number("folds", folds_,
                 {.label = "Folds", .min = 0.5, .max = 60, .help = "Pleats across the width", .redo = Redo::Build});
        v.number("gather", gather_,
                 {.label = "Gather",
                  .min = 0,
                  .max = 0.9,
                  .help = "Share of the width that the tie takes away; 0 hangs free",
                  .redo = Redo::Build});
        v.number("gather-height", gatherHeight_,
                 {.label = "Gather height",
                  .min = 0,
                  .max = 1,
                  .help = "Where the tie is, as a share of the height",
                  .redo = Redo::Build});
        v.number("gather-side", gatherSide_,
                 {.label = "Gather side",
                  .min = -1,
                  .max = 1,
                  .help = "Towards which side the tie pulls",
                  .redo = Redo::Build});
        describeLength(v, "sag", sag_, "Sag", 0, 5, "How far the hem's middle hangs below its ends");
        v.toggle("rod", rod_, {.label = "Rod", .help = "The rod with its knobs and rings", .redo = Redo::Build});
        describeCount(v, "columns", columns_, "Columns", 4, 2000, "Quads across");
        describeCount(v, "rows", rows_, "Rows", 2, 2000, "Quads from top to bottom");
        describeSeed(v, seed_);
    }

    ProceduralResult build() const override {
        Mesh mesh;
        append(mesh,
               gridSurface(
                   columns_, rows_, [&](float u, float v) { return clothPoint(u, v); }, Vec2(width_ * 1.5f, height_)),
               0);
        if (rod_) addRod(mesh);
        return onePart(std::move(mesh), {opaqueSlot("surface", {0.45f, 0.06f, 0.05f}, 0.9f),
                                         opaqueSlot("rod", {0.55f, 0.38f, 0.15f}, 0.3f, 1)});
    }

private:
    Vec3 clothPoint(float u, float v) const {
        const auto seed = static_cast<uint32_t>(seed_);
        const float down = 1 - v;
        // Pleats keep their number but drift sideways as they fall, and no two are alike.
        const float drift = 0.35f * valueNoise(Vec3(u * folds_ * 0.35f, down * 1.3f, 0.5f), seed) * down;
        const float phase = 2 * kPi * (u * folds_ + drift);
        const float size = 0.75f + 0.35f * valueNoise(Vec3(u * folds_ * 0.8f, down * 0.7f, 7.5f), seed);
        const float open = 0.55f + 0.45f * std::pow(down, 0.6f);
        const float pleat = std::sin(phase) + 0.25f * std::sin(2 * phase + 1 + 2 * down);
        const float wrinkle = 0.10f * valueNoise(Vec3(u * folds_ * 3, down * 5, 2.5f), seed + 1) * down;
        const float tie = tieAt(v);
        float x = (u - 0.5f) * width_ * (1 + 0.03f * down * valueNoise(Vec3(u * 3, down * 2, 4), seed));
        x += 0.16f * depth_ * std::cos(phase) * open;
        x = glm::mix(x, gatherSide_ * width_ * 0.42f + x * (1 - gather_), tie);
        const float squeeze = 1 - 0.35f * tie * gather_;
        const float z = 0.5f * depth_ * open * squeeze * (size * pleat + wrinkle * 2);
        const float hem = sag_ > 0 ? sag_ * 4 * u * (1 - u) * down : 0;
        const float lift = 0.012f * height_ * tie * gather_ * (1 - std::abs(u - 0.5f));
        return {x, height_ * v - hem + lift, z};
    }

    /// 1 at the tie, falling off above slowly and below faster to what the freed cloth keeps.
    float tieAt(float v) const {
        if (gather_ == 0) return 0;
        if (v > gatherHeight_) {
            const float t = (v - gatherHeight_) / (1 - gatherHeight_);
            return std::pow(1 - t, 1.6f);
        }
        const float t = (gatherHeight_ - v) / std::max(gatherHeight_, 1e-3f);
        return 1 - 0.38f * glm::smoothstep(0.0f, 1.0f, t);
    }

    void addRod(Mesh& mesh) const {
        const float r = 0.014f, reach = width_ / 2 + 0.08f, y = height_ + r * 1.8f;
        append(mesh, tube({Vec3(-reach, y, 0), Vec3(reach, y, 0)}, {r, r}, 20), 1);
        const Profile knob = smoothProfile({{0, -0.01f},
                                            {r * 1.5f, 0, true},
                                            {r * 1.2f, 0.01f},
                                            {r * 1.2f, 0.016f},
                                            {r * 2.1f, 0.035f},
                                            {r * 1.7f, 0.055f},
                                            {0, 0.066f}},
                                           2);
        append(mesh, lathe(knob, 14), 1, placed({reach, y, 0}, {0, 0, -90}));
        append(mesh, lathe(knob, 14), 1, placed({-reach, y, 0}, {0, 0, 90}));
        const int rings = static_cast<int>(folds_);
        for (int i = 0; i < rings; ++i) {
            std::vector<Vec3> circle;
            const float x = width_ * ((static_cast<float>(i) + 0.5f) / static_cast<float>(rings) - 0.5f);
            for (int k = 0; k <= 10; ++k) {
                const float a = 2 * kPi * static_cast<float>(k) / 10;
                circle.push_back({x, y - 0.006f + 0.024f * std::sin(a), 0.024f * std::cos(a)});
            }
            append(mesh, tube(circle, std::vector<float>(circle.size(), 0.003f), 4, false), 1);
        }
    }

    float width_ = 1.2f, height_ = 2.4f, depth_ = 0.10f, folds_ = 9, gather_ = 0, gatherHeight_ = 0.4f;
    float gatherSide_ = 0, sag_ = 0;
    bool rod_ = false;
    int columns_ = 140, rows_ = 60, seed_ = 1;
};

}  // namespace

std::unique_ptr<Procedural> makeDrape() { return std::make_unique<Drape>(); }

}  // namespace lumi
