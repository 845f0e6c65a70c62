#include <algorithm>
#include <cmath>

#include "scene/procedural/texture_tools.h"

namespace lumi {
namespace {

/// Boards along U with grain, pores, knots of rings and narrow gaps; every board differs in tone.
class Wood final : public ProceduralTexture {
public:
    void describe(ParameterVisitor& v) override {
        settings_.describe(v);
        v.integer("planks", planks_,
                  {.label = "Planks", .min = 1, .max = 64, .help = "Side by side along V", .redo = Redo::Build});
        v.integer("boards", boards_,
                  {.label = "Boards", .min = 1, .max = 16, .help = "End to end along U", .redo = Redo::Build});
        describeColour(v, "light", light_, "Light", "Colour of the early wood");
        describeColour(v, "dark", dark_, "Dark", "Colour of the late wood");
        describeAmount(v, "variation", variation_, "Variation", 0, 1, "How far boards differ in tone");
        describeAmount(v, "gap", gap_, "Gap", 0, 0.05, "Width of the joints, as a share of the tile; 0 for none");
        describeAmount(v, "roughness", roughness_, "Roughness", 0, 1, "Of the varnish");
    }

    TextureImage build() const override {
        return renderPattern("wood", settings_.size, settings_.map, [this](float u, float v) { return texel(u, v); });
    }

private:
    SurfaceTexel texel(float u, float v) const {
        const auto seed = static_cast<uint32_t>(settings_.seed);
        const auto planks = static_cast<float>(planks_), boards = static_cast<float>(boards_);
        const int plank = std::min(static_cast<int>(v * planks), planks_ - 1);
        const float across = v * planks - static_cast<float>(plank);
        const float along = fract(u + randomAt(plank, 1, seed)) * boards;
        const int board = std::min(static_cast<int>(along), boards_ - 1);
        const float local = along - static_cast<float>(board);
        const uint32_t own = hashCombine(static_cast<uint32_t>(plank), static_cast<uint32_t>(board), seed + 7);

        // Growth rings are level lines of a field that is long along the board and wanders across it.
        const float x = local * 3 / boards * 4, y = across * 3;
        const float warp = tiledFractal(x, y * 0.7f, 1 << 20, 1 << 20, 3, own);
        const float rings = 0.5f + 0.5f * std::sin((y * 1.6f + 2.6f * warp + 5 * unitFloat(own)) * 5.2f);
        const float fibre = tiledFractal(x * 3, across * 60, 1 << 20, 1 << 20, 3, own + 3);
        const float pore = std::max(0.0f, tiledNoise(x * 9, across * 110, 1 << 20, 1 << 20, own + 9) - 0.45f);
        const float tone = (2 * randomAt(plank, board, seed + 31) - 1) * variation_;

        SurfaceTexel t;
        const float mixing = std::clamp(0.38f + 0.42f * (std::pow(rings, 1.7f) - 0.4f) + 0.24f * fibre, 0.0f, 1.0f);
        t.colour = glm::mix(light_, dark_, mixing) * (1 + 0.45f * tone) * (1 - 0.5f * pore);
        t.colour *= glm::mix(Vec3(1), Vec3(1.06f, 0.98f, 0.90f), randomAt(plank, board, seed + 77));
        t.roughness = std::clamp(roughness_ + 0.10f * fibre + 0.12f * pore - 0.05f * tone, 0.05f, 1.0f);
        const float joint = gapDepth(across, local, planks, boards);
        t.colour *= 1 - 0.8f * joint;
        t.roughness = glm::mix(t.roughness, 0.9f, joint);
        t.height = 0.00014f * fibre - 0.00025f * pore - 0.0016f * joint + 0.0008f * tone * 0.1f;
        return t;
    }

    /// 1 inside the joints between boards, 0 away from them.
    float gapDepth(float across, float local, float planks, float boards) const {
        if (gap_ == 0) return 0;
        const float side = std::min(across, 1 - across) / planks, end = std::min(local, 1 - local) / boards;
        return 1 - glm::smoothstep(gap_ * 0.35f, gap_, std::min(side, end) * 2);
    }

    PatternSettings settings_;
    int planks_ = 8, boards_ = 2;
    Vec3 light_{0.42f, 0.25f, 0.12f}, dark_{0.20f, 0.10f, 0.045f};
    float variation_ = 0.5f, gap_ = 0.004f, roughness_ = 0.35f;
};

}  // namespace

std::unique_ptr<ProceduralTexture> makeWood() { return std::make_unique<Wood>(); }

}  // namespace lumi
