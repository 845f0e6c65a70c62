#include "scene/procedural/texture_tools.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "math/colour.h"

namespace lumi {
namespace {

uint8_t byteFrom(float x) { return static_cast<uint8_t>(std::lround(255 * std::clamp(x, 0.0f, 1.0f))); }

void writeTexel(uint8_t* out, const Vec3& v) {
    for (int c = 0; c < 3; ++c) out[c] = byteFrom(v[c]);
    out[3] = 255;
}

}  // namespace

TextureImage renderPattern(const char* name, int size, TextureMap map, const SurfacePattern& pattern) {
    TextureImage image;
    image.name = name;
    image.srgb = map == TextureMap::Colour;
    const auto side = static_cast<size_t>(size);
    image.levels.push_back({{size, size}, std::vector<uint8_t>(side * side * 4), {}});
    uint8_t* bytes = image.levels[0].bytes.data();
    const float step = 1 / static_cast<float>(size);
    std::vector<float> heights(map == TextureMap::Normal ? side * side : 0);
    parallelRanges(size, 16, [&](int64_t begin, int64_t end) {
        for (int64_t y = begin; y < end; ++y)
            for (int64_t x = 0; x < size; ++x) {
                const SurfaceTexel t =
                    pattern((static_cast<float>(x) + 0.5f) * step, (static_cast<float>(y) + 0.5f) * step);
                const auto i = static_cast<size_t>(y * size + x);
                if (map == TextureMap::Normal) heights[i] = t.height;
                if (map == TextureMap::Colour) writeTexel(bytes + 4 * i, srgbFromLinear(t.colour));
                if (map == TextureMap::MetallicRoughness) writeTexel(bytes + 4 * i, {1, t.roughness, t.metallic});
            }
    });
    if (map != TextureMap::Normal) return image;
    parallelRanges(size, 16, [&](int64_t begin, int64_t end) {
        const auto at = [&](int64_t x, int64_t y) {
            return heights[static_cast<size_t>((y + size) % size * size + (x + size) % size)];
        };
        for (int64_t y = begin; y < end; ++y)
            for (int64_t x = 0; x < size; ++x) {
                const float du = (at(x + 1, y) - at(x - 1, y)) / (2 * step);
                const float dv = (at(x, y + 1) - at(x, y - 1)) / (2 * step);
                const Vec3 n = glm::normalize(Vec3(-du, dv, 1));
                writeTexel(bytes + 4 * (y * size + x), n * 0.5f + 0.5f);
            }
    });
    return image;
}

void PatternSettings::describe(ParameterVisitor& v) {
    v.choice("map", map,
             {.label = "Map",
              .options = {"color", "normal", "metallic-roughness"},
              .help = "Which image of the surface",
              .redo = Redo::Build});
    v.integer("texels", size,
              {.label = "Texels", .min = 8, .max = 8192, .help = "Along each side", .redo = Redo::Build});
    v.integer("seed", seed,
              {.label = "Seed", .min = 0, .max = 1e6, .help = "Which of the random arrangements", .redo = Redo::Build});
}

float tiledNoise(float x, float y, int periodX, int periodY, uint32_t seed) {
    const float fx = std::floor(x), fy = std::floor(y);
    const float tx = x - fx, ty = y - fy;
    const float sx = tx * tx * (3 - 2 * tx), sy = ty * ty * (3 - 2 * ty);
    // Divisions are most of the work: none where the place lies in the first period already.
    const auto wrap = [](int i, int period) {
        if (i >= 0 && i < period) return i;
        const int rest = i % period;
        return rest < 0 ? rest + period : rest;
    };
    const auto next = [](int i, int period) { return i + 1 < period ? i + 1 : 0; };
    const int x0 = wrap(static_cast<int>(fx), periodX), x1 = next(x0, periodX);
    const int y0 = wrap(static_cast<int>(fy), periodY), y1 = next(y0, periodY);
    const float top = glm::mix(randomAt(x0, y0, seed), randomAt(x1, y0, seed), sx);
    const float bottom = glm::mix(randomAt(x0, y1, seed), randomAt(x1, y1, seed), sx);
    return 2 * glm::mix(top, bottom, sy) - 1;
}

float tiledFractal(float x, float y, int periodX, int periodY, int octaves, uint32_t seed) {
    float sum = 0, weight = 0.55f;
    for (int i = 0; i < octaves; ++i) {
        sum += weight * tiledNoise(x, y, periodX, periodY, seed + static_cast<uint32_t>(i) * 101u);
        x *= 2, y *= 2, periodX *= 2, periodY *= 2, weight *= 0.5f;
    }
    return sum;
}

void describeColour(ParameterVisitor& v, const char* id, Vec3& value, const char* label, const char* help) {
    v.colour(id, value, {.label = label, .max = 1, .help = help, .redo = Redo::Build});
}

void describeAmount(ParameterVisitor& v, const char* id, float& value, const char* label, double min, double max,
                    const char* help) {
    v.number(id, value, {.label = label, .min = min, .max = max, .help = help, .redo = Redo::Build});
}

}  // namespace lumi
