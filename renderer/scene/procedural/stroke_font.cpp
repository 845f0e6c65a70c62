#include "scene/procedural/stroke_font.h"

#include <algorithm>
#include <array>

namespace lumi::stroke_font {
namespace {

/// Units of the grid on which glyphs are drawn: the baseline at 3, capitals up to 11.
constexpr float kBaseline = 3, kCapital = 8, kSpace = 3.2f;

/// `way`: the advance, then lines apart by spaces. A line's points are two hexadecimal digits each, x and y of the
/// grid; with ~ before them they are joined by a curve.
struct Glyph {
    char letter;
    const char* way;
};
constexpr std::array kGlyphs{
    Glyph{'a', "6 ~564828161523435556 5853"},
    Glyph{'b', "6 1b13 ~564828161523435556"},
    Glyph{'c', "6 ~5748281615234354"},
    Glyph{'d', "6 ~564828161523435556 5b53"},
    Glyph{'e', "6 1656 ~5648281615234354"},
    Glyph{'f', "4 ~4b3b2a29 2923 1838"},
    Glyph{'g', "6 ~564828161523435556 5852 ~52402011"},
    Glyph{'h', "6 1b13 ~16284856 5653"},
    Glyph{'i', "2 1813 1a1a"},
    Glyph{'j', "3 2822 ~221000 2a2a"},
    Glyph{'k', "5 1b13 4815 2643"},
    Glyph{'l', "2 1b13"},
    Glyph{'m', "8 1813 ~16283846 4643 ~46586876 7673"},
    Glyph{'n', "6 1813 ~16284856 5653"},
    Glyph{'o', "6 ~564828161523435556"},
    Glyph{'p', "6 1810 ~564828161523435556"},
    Glyph{'q', "6 ~564828161523435556 5850"},
    Glyph{'r', "4 1813 ~16283848"},
    Glyph{'s', "5 ~47382817263544332314"},
    Glyph{'t', "4 2b25 ~25243343 1838"},
    Glyph{'u', "6 1815 ~15234355 5853"},
    Glyph{'v', "6 183358"},
    Glyph{'w', "8 1823486378"},
    Glyph{'x', "6 1853 1358"},
    Glyph{'y', "6 1833 5810"},
    Glyph{'z', "6 18581353"},
    Glyph{'A', "8 134b73 2666"},
    Glyph{'B', "6 131b 1b3b ~3b4a4837 1737 ~37565433 3313"},
    Glyph{'C', "7 ~6a4b2a1816244364"},
    Glyph{'D', "7 131b 1b3b ~3b5a68665433 3313"},
    Glyph{'E', "6 131b 1b5b 1747 1353"},
    Glyph{'F', "6 131b 1b5b 1747"},
    Glyph{'G', "7 ~6a4b2a1816244364 6467 6747"},
    Glyph{'H', "7 131b 636b 1767"},
    Glyph{'I', "2 131b"},
    Glyph{'J', "5 4b45 ~45332314"},
    Glyph{'K', "6 131b 5b16 2853"},
    Glyph{'L', "5 1b13 1353"},
    Glyph{'M', "8 131b 1b46 467b 7b73"},
    Glyph{'N', "7 131b 1b63 636b"},
    Glyph{'O', "8 ~4b2a181624436476786a4b"},
    Glyph{'P', "6 131b 1b3b ~3b5a5837 3717"},
    Glyph{'Q', "8 ~4b2a181624436476786a4b 5573"},
    Glyph{'R', "6 131b 1b3b ~3b5a5837 3717 3753"},
    Glyph{'S', "6 ~5a4b2b19284755432314"},
    Glyph{'T', "6 0b6b 3b33"},
    Glyph{'U', "7 1b16 ~16235366 666b"},
    Glyph{'V', "8 1b437b"},
    Glyph{'W', "a 1b3359739b"},
    Glyph{'X', "7 1b63 136b"},
    Glyph{'Y', "8 1b47 7b47 4743"},
    Glyph{'Z', "7 1b6b13 1363"},
    Glyph{'0', "6 ~3b19153355593b"},
    Glyph{'1', "4 193b 3b33"},
    Glyph{'2', "6 ~192b4b5947 4713 1353"},
    Glyph{'3', "6 ~1a3b4b5937 ~3756543314"},
    Glyph{'4', "7 4b16 1666 4b43"},
    Glyph{'5', "6 5b1b 1b17 ~1748564314"},
    Glyph{'6', "6 ~4b27152343564726"},
    Glyph{'7', "6 1b5b23"},
    Glyph{'8', "6 ~3b1937593b ~3715335537"},
    Glyph{'9', "6 ~3b1937593b ~595523"},
    Glyph{'.', "2 1313"},
    Glyph{',', "2 1312"},
    Glyph{'-', "5 1646"},
    Glyph{':', "2 1414 1717"},
    Glyph{'\'', "2 1b19"},
    Glyph{'(', "3 ~2b191522"},
    Glyph{')', "3 ~0b191502"},
    Glyph{'/', "5 134b"},
};

int digitOf(char c) { return c <= '9' ? c - '0' : c - 'a' + 10; }

const char* wayOf(char letter) {
    const auto found =
        std::find_if(kGlyphs.begin(), kGlyphs.end(), [letter](const Glyph& glyph) { return glyph.letter == letter; });
    return found == kGlyphs.end() ? nullptr : found->way;
}

void addLine(std::string_view line, Vec2 at, float unit, std::vector<PenStroke>& strokes) {
    const bool curved = line.front() == '~';
    std::vector<Vec2> points;
    for (size_t i = curved ? 1 : 0; i + 1 < line.size(); i += 2)
        points.push_back(at + unit * Vec2(static_cast<float>(digitOf(line[i])),
                                          static_cast<float>(digitOf(line[i + 1])) - kBaseline));
    curve(points, curved ? 4 : 1, strokes);
}

/// Adds the letter if strokes are wanted; returns its advance in units of the grid.
float addLetter(char letter, Vec2 at, float unit, std::vector<PenStroke>* strokes) {
    const char* way = wayOf(letter);
    if (!way) return letter == ' ' ? kSpace : 0;
    std::string_view rest(way + 2);
    while (strokes && !rest.empty()) {
        const size_t end = std::min(rest.find(' '), rest.size());
        addLine(rest.substr(0, end), at, unit, *strokes);
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    return static_cast<float>(digitOf(way[0])) + 0.4f;
}

}  // namespace

float write(std::string_view text, Vec2 at, float height, std::vector<PenStroke>& strokes) {
    const float unit = height / kCapital;
    for (const char letter : text) at.x += unit * addLetter(letter, at, unit, &strokes);
    return at.x;
}

float widthOf(std::string_view text, float height) {
    float width = 0;
    for (const char letter : text) width += addLetter(letter, Vec2(0), 1, nullptr);
    return width * height / kCapital;
}

void curve(const std::vector<Vec2>& points, int steps, std::vector<PenStroke>& strokes) {
    for (size_t i = 0; i + 1 < points.size(); ++i) {
        const Vec2 a = points[i > 0 ? i - 1 : 0], b = points[i], c = points[i + 1],
                   d = points[std::min(i + 2, points.size() - 1)];
        Vec2 last = b;
        for (int k = 1; k <= steps; ++k) {
            const float t = static_cast<float>(k) / static_cast<float>(steps);
            const Vec2 bend =
                (c - a) * t + (2.0f * a - 5.0f * b + 4.0f * c - d) * (t * t) + (3.0f * (b - c) + d - a) * (t * t * t);
            const Vec2 next = steps == 1 ? c : b + 0.5f * bend;
            strokes.push_back({last, next});
            last = next;
        }
    }
}

}  // namespace lumi::stroke_font
