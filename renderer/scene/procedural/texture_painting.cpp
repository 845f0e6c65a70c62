#include <algorithm>
#include <array>
#include <cmath>

#include "scene/procedural/texture_tools.h"

namespace lumi {
namespace {

enum class PaintingStyle { Hills, Discs, Fields, Label };

/// A picture for a frame, drawn once over 0 to 1, with brush strokes.
class Painting final : public ProceduralTexture {
public:
    void describe(ParameterVisitor& v) override {
        settings_.describe(v);
        v.choice("style", style_,
                 {.label = "Style",
                  .options = {"hills", "discs", "fields", "label"},
                  .help = "What is painted",
                  .redo = Redo::Build});
    }

    TextureImage build() const override {
        return renderPattern("painting", settings_.size, settings_.map, [this](float u, float v) {
            const auto seed = static_cast<uint32_t>(settings_.seed);
            // Strokes drag the picture a little along themselves.
            const float bx = 0.006f * tiledFractal(u * 30, v * 12, 30, 12, 2, seed + 60);
            const float by = 0.006f * tiledFractal(u * 12, v * 30, 12, 30, 2, seed + 61);
            const float stroke = tiledFractal(u * 20, v * 140, 20, 140, 2, seed + 62);
            const bool paper = style_ == PaintingStyle::Label;
            SurfaceTexel t;
            t.colour = paper ? label(u, v) : picture(u + bx, v + by, seed) * (1 + 0.10f * stroke);
            t.roughness = paper ? 0.8f : 0.6f;
            t.height = paper ? 0 : 0.0007f * stroke;
            return t;
        });
    }

private:
    Vec3 picture(float u, float v, uint32_t seed) const {
        switch (style_) {
            case PaintingStyle::Hills: return hills(u, v, seed);
            case PaintingStyle::Discs: return discs(u, v, seed);
            default: return fields(u, v, seed);
        }
    }

    /// Ridges that fade into haze under a low sun.
    static Vec3 hills(float u, float v, uint32_t seed) {
        const Vec3 high(0.16f, 0.33f, 0.50f), low(0.92f, 0.62f, 0.34f);
        Vec3 colour = glm::mix(high, low, std::pow(std::clamp(v / 0.62f, 0.0f, 1.0f), 1.3f));
        const float sun = glm::length(Vec2(u - 0.66f, (v - 0.40f) * 1.2f));
        colour = glm::mix(colour, Vec3(1.0f, 0.80f, 0.50f), std::exp(-sqr(sun / 0.22f)) * 0.6f);
        if (sun < 0.065f) colour = Vec3(1.0f, 0.86f, 0.62f);
        for (int ridge = 0; ridge < 5; ++ridge) {
            const auto r = static_cast<float>(ridge);
            const float line = 0.47f + 0.115f * r -
                               (0.10f - 0.010f * r) * tiledFractal(u * (2 + r * 0.6f) + r, r * 3.7f, 1 << 20, 1 << 20,
                                                                   4, seed + static_cast<uint32_t>(ridge));
            if (v < line) continue;
            const float near = r / 4, depth = std::clamp((v - line) / 0.16f, 0.0f, 1.0f);
            colour = glm::mix(Vec3(0.52f, 0.46f, 0.46f), Vec3(0.030f, 0.075f, 0.065f), std::pow(near, 0.7f));
            colour = glm::mix(colour, glm::mix(low, colour, 0.35f + 0.65f * near), (1 - near) * depth * 0.8f);
        }
        return colour;
    }

    /// Overlapping discs on a pale ground, each mixing with what lies below it.
    static Vec3 discs(float u, float v, uint32_t seed) {
        const std::array<Vec3, 6> inks = {{{0.62f, 0.09f, 0.05f},
                                           {0.04f, 0.14f, 0.28f},
                                           {0.80f, 0.48f, 0.08f},
                                           {0.02f, 0.02f, 0.025f},
                                           {0.10f, 0.34f, 0.32f},
                                           {0.70f, 0.30f, 0.22f}}};
        Vec3 colour(0.78f, 0.73f, 0.63f);
        for (int i = 0; i < 9; ++i) {
            const Vec2 centre(0.15f + 0.7f * randomAt(i, 0, seed), 0.15f + 0.7f * randomAt(i, 1, seed));
            const float radius = 0.05f + 0.24f * sqr(randomAt(i, 2, seed)), ring = glm::length(Vec2(u, v) - centre);
            const Vec3 ink = inks[static_cast<size_t>(randomAt(i, 3, seed) * 6)];
            const bool hollow = i % 3 == 2;
            if (hollow ? std::abs(ring - radius) < 0.008f : ring < radius)
                colour = glm::mix(colour * ink * 1.4f, ink, 0.65f);
        }
        return colour;
    }

    /// Soft-edged fields of colour above each other.
    static Vec3 fields(float u, float v, uint32_t seed) {
        const std::array<Vec3, 4> palette = {
            {{0.50f, 0.12f, 0.05f}, {0.72f, 0.36f, 0.06f}, {0.22f, 0.04f, 0.05f}, {0.82f, 0.60f, 0.28f}}};
        const float cloud = tiledFractal(u * 5, v * 5, 5, 5, 5, seed);
        Vec3 colour = palette[2] * (1 + 0.3f * cloud);
        constexpr std::array<Vec2, 3> kBands = {{{0.06f, 0.38f}, {0.42f, 0.62f}, {0.66f, 0.95f}}};
        for (size_t i = 0; i < kBands.size(); ++i) {
            const float inside = std::min({u - 0.07f, 0.93f - u, v - kBands[i].x, kBands[i].y - v});
            const float cover = glm::smoothstep(-0.006f, 0.018f, inside + 0.014f * cloud);
            colour = glm::mix(colour, palette[(i * 3 + seed) % 4] * (1 + 0.25f * cloud), cover * 0.92f);
        }
        return colour;
    }

    /// A wine label: double rule, a crest, lines of print.
    static Vec3 label(float u, float v) {
        const Vec3 paper(0.80f, 0.75f, 0.62f), ink(0.05f, 0.035f, 0.03f), gold(0.48f, 0.32f, 0.10f),
            red(0.35f, 0.02f, 0.025f);
        const float edge = std::min({u, 1 - u, (v)*0.8f, (1 - v) * 0.8f});
        if (edge > 0.035f && edge < 0.047f) return gold;
        if (edge > 0.058f && edge < 0.062f) return ink;
        const float crest = glm::length(Vec2((u - 0.5f) * 1.5f, v - 0.28f));
        if (crest < 0.115f)
            return crest > 0.100f ? gold : std::abs(u - 0.5f) * 1.5f + std::abs(v - 0.28f) < 0.06f ? gold : red;
        const auto line = [&](float y, float tall, float half, float pitch) {
            if (std::abs(v - y) > tall || std::abs(u - 0.5f) > half) return false;
            const float letter = fract(u / pitch),
                        cell = randomAt(static_cast<int>(u / pitch), static_cast<int>(y * 100), 5);
            return letter > 0.18f && (cell > 0.3f || std::abs(v - y) > tall * 0.55f);
        };
        if (line(0.50f, 0.040f, 0.34f, 0.052f)) return ink;
        if (line(0.61f, 0.014f, 0.22f, 0.020f)) return red;
        for (int i = 0; i < 3; ++i)
            if (line(0.72f + 0.05f * static_cast<float>(i), 0.009f, 0.30f - 0.05f * static_cast<float>(i), 0.013f))
                return ink * 3.0f;
        return paper;
    }

    PatternSettings settings_;
    PaintingStyle style_ = PaintingStyle::Hills;
};

}  // namespace

std::unique_ptr<ProceduralTexture> makePainting() { return std::make_unique<Painting>(); }

}  // namespace lumi
