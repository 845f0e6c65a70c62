#pragma once
#include <string_view>
#include <vector>

#include "math/vector.h"

namespace lumi {

/// A straight piece of a pen's way; both ends may be one point, which is a dot.
struct PenStroke {
    Vec2 from, to;
};

/// Letters drawn by a pen of constant width: Latin letters, digits, `. , - : ' ( ) /` and space. Other characters are
/// left out. y runs up; the baseline is y = 0, capitals are 1 high, small letters 0.625, and descenders reach -0.375.
namespace stroke_font {

/// Adds the strokes of `text`, its capitals `height` high, from `at` on the baseline to the right; returns where the
/// next letter would stand.
float write(std::string_view text, Vec2 at, float height, std::vector<PenStroke>& strokes);
float widthOf(std::string_view text, float height);

/// Adds a smooth curve through the points (Catmull-Rom, ends included) in `steps` pieces between two of them.
void curve(const std::vector<Vec2>& points, int steps, std::vector<PenStroke>& strokes);

}  // namespace stroke_font
}  // namespace lumi
