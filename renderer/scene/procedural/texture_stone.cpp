#include <algorithm>
#include <cmath>

#include "scene/procedural/texture_tools.h"

namespace lumi {
namespace {

/// Thin bright or dark veins of marble: level lines of a warped fractal, in [0, 1].
float veins(float x, float y, int period, uint32_t seed) {
    const float warp = tiledFractal(x * 2, y * 2, 2 * period, 2 * period, 4, seed);
    const float field = tiledFractal(x + 0.9f * warp, y - 0.7f * warp, 1 << 20, 1 << 20, 3, seed + 5);
    const float strong = std::pow(std::max(0.0f, 1 - 7 * std::abs(field)), 1.5f);
    const float fine = std::pow(std::max(0.0f, 1 - 12 * std::abs(field - 0.22f)), 2.0f);
    return std::min(1.0f, strong + 0.5f * fine);
}

/// Square floor tiles with grout, each cut from another place of a veined stone; optionally two colours in turn.
class Tiles final : public ProceduralTexture {
public:
    void describe(ParameterVisitor& v) override {
        settings_.describe(v);
        v.integer("tiles", tiles_,
                  {.label = "Tiles", .min = 1, .max = 64, .help = "Along each side", .redo = Redo::Build});
        describeColour(v, "first", first_, "First", "Colour of the stone");
        describeColour(v, "second", second_, "Second", "Colour of every other tile");
        describeColour(v, "vein", vein_, "Vein", "Colour of the veins");
        describeColour(v, "grout", grout_, "Grout", "Colour of the joints");
        describeAmount(v, "gap", gap_, "Gap", 0, 0.2, "Width of the joints, as a share of a tile");
        describeAmount(v, "variation", variation_, "Variation", 0, 1, "How far tiles differ in tone");
        describeAmount(v, "roughness", roughness_, "Roughness", 0, 1, "Of the polish");
    }

    TextureImage build() const override {
        return renderPattern("tiles", settings_.size, settings_.map, [this](float u, float v) { return texel(u, v); });
    }

private:
    SurfaceTexel texel(float u, float v) const {
        const auto seed = static_cast<uint32_t>(settings_.seed);
        const auto count = static_cast<float>(tiles_);
        const int column = std::min(static_cast<int>(u * count), tiles_ - 1);
        const int row = std::min(static_cast<int>(v * count), tiles_ - 1);
        const float x = u * count - static_cast<float>(column), y = v * count - static_cast<float>(row);
        const uint32_t own = hashCombine(static_cast<uint32_t>(column), static_cast<uint32_t>(row), seed);
        const float tone = (2 * unitFloat(own) - 1) * variation_;
        const float cloud = tiledFractal(x * 2.5f, y * 2.5f, 1 << 20, 1 << 20, 5, own);
        const float vein = veins(x * 1.4f, y * 1.4f, 1 << 10, own + 2);
        const float wear = 0.5f + 0.5f * tiledFractal(u * 3, v * 3, 3, 3, 4, seed + 40);

        SurfaceTexel t;
        t.colour = ((column + row) % 2 == 0 ? first_ : second_) * (1 + 0.4f * tone + 0.16f * cloud);
        t.colour = glm::mix(t.colour, vein_, 0.55f * vein);
        t.roughness = std::clamp(roughness_ + 0.22f * (wear - 0.5f) + 0.08f * cloud, 0.05f, 1.0f);
        const float edge = std::min({x, 1 - x, y, 1 - y});
        const float chip = 0.25f * gap_ * tiledNoise(x * 24, y * 24, 1 << 20, 1 << 20, own + 4);
        const float joint = gap_ > 0 ? 1 - glm::smoothstep(gap_ * 0.35f, gap_ * 0.7f, edge + chip) : 0;
        t.colour = glm::mix(t.colour, grout_ * (1 + 0.3f * cloud), joint);
        t.roughness = glm::mix(t.roughness, 0.95f, joint);
        const float slope = glm::smoothstep(0.0f, gap_ * 1.6f, edge);
        t.height = (0.05f * gap_ * slope - 0.05f * gap_ * joint + 0.0015f * cloud + 0.003f * tone * edge) / count;
        return t;
    }

    PatternSettings settings_;
    int tiles_ = 4;
    Vec3 first_{0.55f, 0.48f, 0.38f}, second_{0.55f, 0.48f, 0.38f}, vein_{0.35f, 0.27f, 0.18f},
        grout_{0.20f, 0.17f, 0.13f};
    float gap_ = 0.02f, variation_ = 0.35f, roughness_ = 0.3f;
};

/// Courses of dressed stone or brick in running bond.
class Masonry final : public ProceduralTexture {
public:
    void describe(ParameterVisitor& v) override {
        settings_.describe(v);
        v.integer("courses", courses_,
                  {.label = "Courses", .min = 2, .max = 64, .help = "Rows above each other", .redo = Redo::Build});
        v.integer("blocks", blocks_, {.label = "Blocks", .min = 1, .max = 64, .help = "In a row", .redo = Redo::Build});
        describeColour(v, "stone", stone_, "Stone", "Mean colour of the blocks");
        describeColour(v, "mortar", mortar_, "Mortar", "Colour of the joints");
        describeAmount(v, "gap", gap_, "Gap", 0, 0.1, "Width of the joints, as a share of the tile");
        describeAmount(v, "variation", variation_, "Variation", 0, 1, "How far blocks differ in tone and hue");
        describeAmount(v, "relief", relief_, "Relief", 0, 4, "How rough the blocks' faces are");
    }

    TextureImage build() const override {
        return renderPattern("masonry", settings_.size, settings_.map,
                             [this](float u, float v) { return texel(u, v); });
    }

private:
    SurfaceTexel texel(float u, float v) const {
        const auto seed = static_cast<uint32_t>(settings_.seed);
        const auto courses = static_cast<float>(courses_), blocks = static_cast<float>(blocks_);
        const int course = std::min(static_cast<int>(v * courses), courses_ - 1);
        const float along = fract(u + (course % 2 == 0 ? 0 : 0.5f / blocks)) * blocks;
        const int block = std::min(static_cast<int>(along), blocks_ - 1);
        const float x = (along - static_cast<float>(block)) / blocks,
                    y = (v * courses - static_cast<float>(course)) / courses;
        const float edge = std::min({x, 1 / blocks - x, y, 1 / courses - y});
        const uint32_t own = hashCombine(static_cast<uint32_t>(course), static_cast<uint32_t>(block), seed);
        const float tone = 2 * unitFloat(own) - 1, hue = 2 * unitFloat(own + 1) - 1;
        const float grain = tiledFractal(u * 24, v * 24, 24, 24, 5, seed + 3);
        const float stain = tiledFractal(u * 3, v * 3, 3, 3, 4, seed + 9);

        SurfaceTexel t;
        t.colour = stone_ * (1 + variation_ * 0.35f * tone + 0.13f * grain + 0.14f * stain);
        t.colour *=
            glm::mix(Vec3(1), hue > 0 ? Vec3(1.08f, 1, 0.9f) : Vec3(0.95f, 0.99f, 1.04f), std::abs(hue) * variation_);
        const float wobble = gap_ * 0.3f * tiledNoise(u * 40, v * 40, 40, 40, seed + 17);
        const float joint = gap_ > 0 ? 1 - glm::smoothstep(gap_ * 0.3f, gap_ * 0.65f, edge + wobble) : 0;
        t.colour = glm::mix(t.colour, mortar_ * (1 + 0.2f * grain), joint);
        t.roughness = std::clamp(0.82f + 0.12f * grain, 0.3f, 1.0f);
        const float round = glm::smoothstep(0.0f, gap_ * 2, edge);
        t.height = 0.0030f * round - 0.0022f * joint + relief_ * (0.0011f * grain + 0.0005f * tone * round);
        return t;
    }

    PatternSettings settings_;
    int courses_ = 6, blocks_ = 3;
    Vec3 stone_{0.55f, 0.47f, 0.37f}, mortar_{0.42f, 0.37f, 0.30f};
    float gap_ = 0.008f, variation_ = 0.5f, relief_ = 1;
};

/// Limewash and plaster: soft clouds of tone, trowel marks, fine grain.
class Plaster final : public ProceduralTexture {
public:
    void describe(ParameterVisitor& v) override {
        settings_.describe(v);
        describeColour(v, "color", colour_, "Colour", "Mean colour");
        describeAmount(v, "variation", variation_, "Variation", 0, 1, "Strength of the clouds");
        describeAmount(v, "relief", relief_, "Relief", 0, 4, "Height of the trowel marks");
    }

    TextureImage build() const override {
        const auto seed = static_cast<uint32_t>(settings_.seed);
        return renderPattern("plaster", settings_.size, settings_.map, [&](float u, float v) {
            const float cloud = tiledFractal(u * 3, v * 3, 3, 3, 5, seed);
            const float trowel = tiledFractal(u * 9 + cloud, v * 14, 9, 14, 3, seed + 8);
            const float grain = tiledNoise(u * 180, v * 180, 180, 180, seed + 20);
            SurfaceTexel t;
            t.colour = colour_ * (1 + variation_ * (0.18f * cloud + 0.07f * trowel));
            t.roughness = std::clamp(0.85f + 0.1f * trowel, 0.3f, 1.0f);
            t.height = relief_ * (0.0022f * trowel + 0.00012f * grain);
            return t;
        });
    }

private:
    PatternSettings settings_;
    Vec3 colour_{0.72f, 0.68f, 0.60f};
    float variation_ = 0.5f, relief_ = 1;
};

}  // namespace

std::unique_ptr<ProceduralTexture> makeTiles() { return std::make_unique<Tiles>(); }
std::unique_ptr<ProceduralTexture> makeMasonry() { return std::make_unique<Masonry>(); }
std::unique_ptr<ProceduralTexture> makePlaster() { return std::make_unique<Plaster>(); }

}  // namespace lumi
