#include <algorithm>
#include <array>
#include <cmath>

#include "scene/procedural/texture_tools.h"

namespace lumi {
namespace {

/// Plain or twill weave of two yarns.
class Weave final : public ProceduralTexture {
public:
    void describe(ParameterVisitor& v) override {
        settings_.describe(v);
        v.integer("threads", threads_,
                  {.label = "Threads", .min = 2, .max = 512, .help = "Along each side", .redo = Redo::Build});
        v.integer("float", float_,
                  {.label = "Float",
                   .min = 1,
                   .max = 4,
                   .help = "Threads passed over: 1 is plain weave, 2 a twill",
                   .redo = Redo::Build});
        describeColour(v, "warp", warp_, "Warp", "Colour of the threads along V");
        describeColour(v, "weft", weft_, "Weft", "Colour of the threads along U");
        describeAmount(v, "slub", slub_, "Slub", 0, 1, "Unevenness of the yarn");
    }

    TextureImage build() const override {
        return renderPattern("weave", settings_.size, settings_.map, [this](float u, float v) { return texel(u, v); });
    }

private:
    SurfaceTexel texel(float u, float v) const {
        const auto seed = static_cast<uint32_t>(settings_.seed);
        const auto count = static_cast<float>(threads_);
        const float x = u * count, y = v * count;
        const int i = static_cast<int>(x), j = static_cast<int>(y);
        const bool warpUp = (i + (float_ == 1 ? j : j * (float_ + 2))) % (2 * float_) < float_;
        const float acrossWarp = 2 * (x - static_cast<float>(i)) - 1, acrossWeft = 2 * (y - static_cast<float>(j)) - 1;
        const float across = warpUp ? acrossWarp : acrossWeft, along = warpUp ? acrossWeft : acrossWarp;
        const float bulge = std::sqrt(std::max(0.0f, 1 - across * across)) * (1 - 0.35f * along * along);
        const float yarn = warpUp ? randomAt(i, 0, seed) : randomAt(j, 1, seed);
        const float uneven = warpUp ? tiledNoise(static_cast<float>(i) + 0.5f, v * 12, threads_, 12, seed + 3)
                                    : tiledNoise(u * 12, static_cast<float>(j) + 0.5f, 12, threads_, seed + 4);
        SurfaceTexel t;
        t.colour =
            (warpUp ? warp_ : weft_) * (0.72f + 0.28f * bulge) * (1 + slub_ * (0.22f * (yarn - 0.5f) + 0.25f * uneven));
        t.roughness = 0.92f;
        t.height = 0.28f * bulge / count * (1 + 0.3f * slub_ * uneven);
        return t;
    }

    PatternSettings settings_;
    int threads_ = 64, float_ = 1;
    Vec3 warp_{0.40f, 0.40f, 0.42f}, weft_{0.34f, 0.34f, 0.36f};
    float slub_ = 0.6f;
};

/// A knotted rug over the whole of 0 to 1: guard stripes, a border of rosettes, a field with lozenges, a medallion.
class Carpet final : public ProceduralTexture {
public:
    void describe(ParameterVisitor& v) override {
        settings_.describe(v);
        describeAmount(v, "aspect", aspect_, "Aspect", 0.2, 5, "Width over depth of the rug");
        describeColour(v, "field", field_, "Field", "Colour of the ground");
        describeColour(v, "border", border_, "Border", "Colour of the border's ground");
        describeColour(v, "light", light_, "Light", "Colour of the outlines");
        describeColour(v, "accent", accent_, "Accent", "Colour of the ornaments");
    }

    TextureImage build() const override {
        return renderPattern("carpet", settings_.size, settings_.map, [this](float u, float v) { return texel(u, v); });
    }

private:
    SurfaceTexel texel(float u, float v) const {
        const auto seed = static_cast<uint32_t>(settings_.seed);
        // Knots are square and every knot has one colour.
        const float knots = 220;
        const float x = (std::floor(u * knots * aspect_) + 0.5f) / knots - aspect_ / 2;
        const float y = (std::floor(v * knots) + 0.5f) / knots - 0.5f;
        SurfaceTexel t;
        t.colour = colourAt(x, y);
        // Each row of knots takes the dye a little differently.
        const float row = randomAt(static_cast<int>(v * knots), 3, seed) - 0.5f;
        const float knot = randomAt(static_cast<int>(u * knots * aspect_), static_cast<int>(v * knots), seed) - 0.5f;
        t.colour *= 1 + 0.14f * row + 0.22f * knot + 0.12f * tiledFractal(u * 4, v * 4, 4, 4, 3, seed);
        t.roughness = 0.95f;
        const float pu = fract(u * knots * aspect_) - 0.5f, pv = fract(v * knots) - 0.5f;
        t.height = 0.0012f * (1 - 2 * std::max(std::abs(pu), std::abs(pv))) + 0.0005f * knot;
        return t;
    }

    /// A star of eight points around the origin: negative inside.
    static float star(float x, float y, float size) {
        const float a = std::abs(x), b = std::abs(y);
        const float square = std::max(a, b), diamond = (a + b) * 0.7071f;
        return std::min(square, diamond) * 1.12f + 0.25f * std::max(square, diamond) - size;
    }

    Vec3 colourAt(float x, float y) const {
        const float edge = std::min(aspect_ / 2 - std::abs(x), 0.5f - std::abs(y));
        if (edge < 0.012f) return border_ * 0.5f;
        if (edge < 0.030f) return fract((x + y) * 22) < 0.5f ? light_ : accent_;
        if (edge < 0.038f) return border_ * 0.35f;
        if (edge < 0.118f) return borderAt(x, y, edge);
        if (edge < 0.126f) return border_ * 0.35f;
        if (edge < 0.142f) return fract((x - y) * 26) < 0.5f ? light_ : field_;
        if (edge < 0.148f) return border_ * 0.35f;
        return fieldAt(x, y);
    }

    Vec3 borderAt(float x, float y, float edge) const {
        const bool side = aspect_ / 2 - std::abs(x) < 0.5f - std::abs(y);
        const float along = side ? y : x, across = edge - 0.078f, pitch = 0.092f;
        const float cell = (fract(along / pitch + 0.5f) - 0.5f) * pitch;
        const float rosette = star(cell, across, 0.030f);
        if (rosette < -0.020f) return light_;
        if (rosette < -0.008f) return accent_;
        if (rosette < 0) return light_ * 0.8f;
        const float vine = across - 0.020f * std::sin(2 * kPi * along / pitch);
        return std::abs(vine) < 0.0045f ? light_ * 0.75f : border_;
    }

    Vec3 fieldAt(float x, float y) const {
        const float medallion = star(x, y, 0.215f);
        if (medallion < -0.170f) return light_;
        if (medallion < -0.155f) return border_ * 0.4f;
        if (medallion < -0.095f) return fract(std::atan2(y, x) * 16 / (2 * kPi)) < 0.5f ? accent_ : field_ * 0.7f;
        if (medallion < -0.085f) return light_;
        if (medallion < -0.014f) return star(std::abs(x) - 0.13f, std::abs(y) - 0.08f, 0.02f) < 0 ? light_ : border_;
        if (medallion < 0) return light_;
        const float px = 0.115f, py = 0.1f;
        const float cx = (fract(x / px + 0.5f) - 0.5f) * px, cy = (fract(y / py + 0.5f) - 0.5f) * py;
        const float lozenge = std::abs(cx) / 0.034f + std::abs(cy) / 0.042f;
        if (lozenge < 0.35f) return light_;
        if (lozenge < 0.75f) return accent_;
        if (lozenge < 0.95f) return border_ * 0.5f;
        return std::min(std::abs(cx + cy * 1.1f), std::abs(cx - cy * 1.1f)) < 0.0028f ? field_ * 1.6f : field_;
    }

    PatternSettings settings_;
    float aspect_ = 1.4f;
    Vec3 field_{0.36f, 0.045f, 0.035f}, border_{0.035f, 0.06f, 0.14f}, light_{0.66f, 0.55f, 0.38f},
        accent_{0.55f, 0.27f, 0.08f};
};

}  // namespace

std::unique_ptr<ProceduralTexture> makeWeave() { return std::make_unique<Weave>(); }
std::unique_ptr<ProceduralTexture> makeCarpet() { return std::make_unique<Carpet>(); }

}  // namespace lumi
