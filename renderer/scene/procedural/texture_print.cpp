#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "base/parallel.h"
#include "math/colour.h"
#include "scene/procedural/stroke_font.h"
#include "scene/procedural/texture_tools.h"

namespace lumi {
namespace {

/// What the sheet says, again and again.
constexpr std::string_view kText =
    "A picture that moves is judged twice: once for what each frame shows, and once for what the eye sees between two "
    "frames. "
    "Thin lines are the hardest part of both. A line that is narrower than a pixel is met by one ray and missed by the "
    "next, so "
    "that letters lose their stems, rules break into dashes, and what stood still on paper begins to crawl on the "
    "screen. "
    "More rays help slowly, a longer memory helps at the price of a blur. The third way is to keep the points that "
    "were "
    "looked at, to carry them along with the surface they lie on, and to ask only whether they can still be seen. "
    "Such points do not tremble: a stem that was met stays met while the sheet slides by. What they cost is an uneven "
    "spread over the pixels, and edges that are a little too thick or too thin until somebody looks again. "
    "Set in 1717 lines, at 8 of 12 points, 0.25 mm apart, (proof 3) for reading by lamp light. ";

/// Strokes of one pen width, all in units of the sheet's width; y runs up from the sheet's bottom.
struct PenLayer {
    float width = 0.001f;
    bool accent = false;
    std::vector<PenStroke> strokes;
};

void addRing(Vec2 centre, float radius, std::vector<PenStroke>& strokes) {
    const int steps = std::max(24, static_cast<int>(radius * 900));
    const auto at = [&](int i) {
        const float a = 2 * kPi * static_cast<float>(i) / static_cast<float>(steps);
        return centre + radius * Vec2(std::cos(a), std::sin(a));
    };
    for (int i = 0; i < steps; ++i) strokes.push_back({at(i), at(i + 1)});
}

/// Spokes between two rings: a star that gets finer towards its centre.
void addStar(Vec2 centre, float radius, int spokes, std::vector<PenStroke>& strokes) {
    for (int i = 0; i < spokes; ++i) {
        const float a = 2 * kPi * static_cast<float>(i) / static_cast<float>(spokes);
        const Vec2 way(std::cos(a), std::sin(a));
        strokes.push_back({centre + 0.12f * radius * way, centre + radius * way});
    }
    addRing(centre, radius, strokes);
}

/// A rosette as engine turning draws it: a circle whose radius swings, turned around its centre.
void addRosette(Vec2 centre, float radius, int turns, std::vector<PenStroke>& strokes) {
    constexpr int kSteps = 220;
    for (int turn = 0; turn < turns; ++turn) {
        const float shift = 2 * kPi * static_cast<float>(turn) / static_cast<float>(turns);
        const auto at = [&](int i) {
            const float a = 2 * kPi * static_cast<float>(i) / kSteps;
            const float r = radius * (0.62f + 0.30f * std::cos(7 * a + shift) + 0.08f * std::cos(21 * a - 2 * shift));
            return centre + r * Vec2(std::cos(a), std::sin(a));
        };
        for (int i = 0; i < kSteps; ++i) strokes.push_back({at(i), at(i + 1)});
    }
}

/// A field of lines at `angle`, `pitch` apart, within a square.
void addHatching(Vec2 low, float side, float angle, float pitch, std::vector<PenStroke>& strokes) {
    const Vec2 way(std::cos(angle), std::sin(angle)), across(-way.y, way.x), centre = low + Vec2(0.5f * side);
    for (float offset = -side; offset < side; offset += pitch) {
        float begin = -2 * side, end = 2 * side;
        for (int axis = 0; axis < 2; ++axis) {
            const float from = across[axis] * offset, rate = way[axis];
            if (std::abs(rate) < 1e-6f) {
                if (std::abs(from) > 0.5f * side) begin = end = 0;
                continue;
            }
            const float a = (-0.5f * side - from) / rate, b = (0.5f * side - from) / rate;
            begin = std::max(begin, std::min(a, b)), end = std::min(end, std::max(a, b));
        }
        if (begin < end)
            strokes.push_back({centre + across * offset + way * begin, centre + across * offset + way * end});
    }
}

/// Waves whose pitch narrows from line to line.
void addWaves(Vec2 low, Vec2 size, std::vector<PenStroke>& strokes) {
    constexpr int kLines = 26, kSteps = 160;
    for (int line = 0; line < kLines; ++line) {
        const float y = low.y + size.y * (static_cast<float>(line) + 0.5f) / kLines,
                    waves = 3 + static_cast<float>(line);
        const auto at = [&](int i) {
            const float x = static_cast<float>(i) / kSteps;
            return Vec2(low.x + size.x * x, y + 0.42f * size.y / kLines * std::sin(2 * kPi * waves * x));
        };
        for (int i = 0; i < kSteps; ++i) strokes.push_back({at(i), at(i + 1)});
    }
}

/// Lines of text between two margins, from `top` downwards to `bottom`, words broken at spaces only.
void addColumn(float left, float right, float top, float bottom, float height, size_t& place,
               std::vector<PenStroke>& strokes) {
    for (float y = top - height; y > bottom; y -= 1.75f * height) {
        float x = left;
        for (;;) {
            const size_t start = place % kText.size(), end = std::min(kText.find(' ', start), kText.size());
            const std::string_view word = kText.substr(start, end - start);
            if (x + stroke_font::widthOf(word, height) > right) break;
            x = stroke_font::write(word, {x, y}, height, strokes) + stroke_font::widthOf(" ", height);
            place = start + word.size() + 1;
        }
    }
}

/// A sheet of fine print and line art, drawn once over 0 to 1.
class Print final : public ProceduralTexture {
public:
    void describe(ParameterVisitor& v) override {
        settings_.describe(v);
        describeColour(v, "paper", paper_, "Paper", "Colour of the sheet");
        describeColour(v, "ink", ink_, "Ink", "Colour of print and lines");
        describeColour(v, "accent", accent_, "Accent", "Colour of headings and of some lines");
        describeAmount(v, "weight", weight_, "Weight", 0.2, 4, "Width of all strokes as a multiple of the design's");
    }

    TextureImage build() const override {
        const auto side = static_cast<size_t>(settings_.size);
        std::vector<uint8_t> ink(side * side), accent(side * side);
        for (const PenLayer& layer : layout()) draw(layer, layer.accent ? accent : ink);
        if (settings_.map == TextureMap::Colour) return colourMap(ink, accent);
        return renderPattern("print", settings_.size, settings_.map, [&](float u, float v) {
            const auto at = static_cast<size_t>(v * static_cast<float>(side)) * side +
                            static_cast<size_t>(u * static_cast<float>(side));
            const float black = static_cast<float>(ink[at]) / 255, red = static_cast<float>(accent[at]) / 255;
            SurfaceTexel t;
            t.height = -0.0004f * std::max(black, red);
            t.roughness = glm::mix(0.85f, 0.4f, std::max(black, red));
            return t;
        });
    }

private:
    Vec3 colourAt(float black, float red) const {
        return srgbFromLinear(glm::mix(glm::mix(paper_, accent_, red), ink_, black));
    }

    /// As renderPattern() has it; nearly every texel is paper, or has one ink alone, so that few colours are worked
    /// out.
    TextureImage colourMap(const std::vector<uint8_t>& ink, const std::vector<uint8_t>& accent) const {
        std::array<Vec3, 256> black, red;
        for (size_t i = 0; i < 256; ++i) {
            black[i] = colourAt(static_cast<float>(i) / 255, 0);
            red[i] = colourAt(0, static_cast<float>(i) / 255);
        }
        TextureImage image;
        image.name = "print";
        image.srgb = true;
        image.levels.push_back({{settings_.size, settings_.size}, std::vector<uint8_t>(4 * ink.size()), {}});
        uint8_t* bytes = image.levels[0].bytes.data();
        parallelRanges(static_cast<int64_t>(ink.size()), 1 << 16, [&](int64_t begin, int64_t end) {
            for (auto i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i) {
                const bool both = ink[i] > 0 && accent[i] > 0;
                const Vec3 colour =
                    both         ? colourAt(static_cast<float>(ink[i]) / 255, static_cast<float>(accent[i]) / 255)
                    : ink[i] > 0 ? black[ink[i]]
                                 : red[accent[i]];
                for (size_t c = 0; c < 3; ++c)
                    bytes[4 * i + c] =
                        static_cast<uint8_t>(255 * std::clamp(colour[static_cast<int>(c)], 0.0f, 1.0f) + 0.5f);
                bytes[4 * i + 3] = 255;
            }
        });
        return image;
    }

    /// Which paragraph the text begins with is the seed's.
    std::vector<PenLayer> layout() const {
        PenLayer heading{0.0062f, true, {}}, title{0.0034f, false, {}}, body{0.0011f, false, {}},
            small{0.0008f, false, {}}, rules{0.0012f, false, {}}, hair{0.0007f, false, {}}, red{0.0009f, true, {}};
        stroke_font::write("Fine print", {0.05f, 0.895f}, 0.056f, heading.strokes);
        stroke_font::write("a proof sheet of lines and letters", {0.052f, 0.852f}, 0.018f, title.strokes);
        stroke_font::write("No. 17", {0.835f, 0.905f}, 0.03f, title.strokes);
        for (const float y : {0.955f, 0.838f, 0.045f}) rules.strokes.push_back({{0.05f, y}, {0.95f, y}});
        for (const float x : {0.345f, 0.655f}) rules.strokes.push_back({{x, 0.06f}, {x, 0.56f}});
        size_t place = kText.find(' ', static_cast<size_t>(settings_.seed) * 97 % (kText.size() - 1)) + 1;
        addColumn(0.05f, 0.33f, 0.56f, 0.06f, 0.0125f, place, body.strokes);
        addColumn(0.36f, 0.64f, 0.56f, 0.06f, 0.0095f, place, small.strokes);
        addColumn(0.67f, 0.95f, 0.56f, 0.31f, 0.0070f, place, small.strokes);
        addStar({0.17f, 0.70f}, 0.115f, 96, hair.strokes);
        addRosette({0.42f, 0.70f}, 0.12f, 14, red.strokes);
        for (int i = 1; i <= 30; ++i)
            addRing({0.66f, 0.70f}, 0.118f * std::sqrt(static_cast<float>(i) / 30), hair.strokes);
        for (int i = 0; i < 4; ++i)
            addHatching(
                {0.80f + 0.078f * static_cast<float>(i % 2), 0.70f - 0.078f * static_cast<float>(i / 2) + 0.022f},
                0.07f, 0.3f + 0.6f * static_cast<float>(i), 0.0022f + 0.0012f * static_cast<float>(i), hair.strokes);
        addWaves({0.67f, 0.06f}, {0.28f, 0.23f}, red.strokes);
        return {heading, title, body, small, rules, hair, red};
    }

    /// How much of each texel the strokes cover, by the distance of its centre from them.
    void draw(const PenLayer& layer, std::vector<uint8_t>& coverage) const {
        const auto side = static_cast<float>(settings_.size);
        const float half = 0.5f * layer.width * weight_ * side, reach = half + 1;
        parallelRanges(settings_.size, std::max(16, settings_.size / 32), [&](int64_t begin, int64_t end) {
            for (const PenStroke& stroke : layer.strokes) {
                const Vec2 a(stroke.from.x * side, (1 - stroke.from.y) * side),
                    b(stroke.to.x * side, (1 - stroke.to.y) * side);
                const int top = std::max(static_cast<int>(begin), static_cast<int>(std::min(a.y, b.y) - reach));
                const int bottom = std::min(static_cast<int>(end), static_cast<int>(std::max(a.y, b.y) + reach) + 1);
                for (int y = top; y < bottom; ++y) drawRow(a, b, half, y, coverage);
            }
        });
    }

    void drawRow(Vec2 a, Vec2 b, float half, int y, std::vector<uint8_t>& coverage) const {
        const Vec2 way = b - a;
        const float squared = std::max(glm::dot(way, way), 1e-12f), row = static_cast<float>(y) + 0.5f;
        // Along the row only what lies near the piece of the stroke at this height.
        float left = std::min(a.x, b.x), right = std::max(a.x, b.x);
        if (std::abs(way.y) > 1e-3f && std::abs(way.x) > 2 * (half + 1)) {
            const float slope = way.x / way.y, spread = (half + 1) * std::sqrt(1 + slope * slope),
                        x = a.x + slope * (row - a.y);
            left = std::max(left, x - spread), right = std::min(right, x + spread);
        }
        const int first = std::max(0, static_cast<int>(left - half - 1)),
                  last = std::min(settings_.size - 1, static_cast<int>(right + half + 1));
        for (int x = first; x <= last; ++x) {
            const Vec2 p = Vec2(static_cast<float>(x) + 0.5f, row) - a;
            const float t = std::clamp(glm::dot(p, way) / squared, 0.0f, 1.0f);
            const float cover = std::clamp(half + 0.5f - glm::length(p - t * way), 0.0f, 1.0f);
            uint8_t& texel =
                coverage[static_cast<size_t>(y) * static_cast<size_t>(settings_.size) + static_cast<size_t>(x)];
            texel = std::max(texel, static_cast<uint8_t>(std::lround(255 * cover)));
        }
    }

    PatternSettings settings_;
    Vec3 paper_{0.84f, 0.81f, 0.73f}, ink_{0.018f, 0.018f, 0.024f}, accent_{0.55f, 0.045f, 0.03f};
    float weight_ = 1;
};

}  // namespace

std::unique_ptr<ProceduralTexture> makePrint() { return std::make_unique<Print>(); }

}  // namespace lumi
