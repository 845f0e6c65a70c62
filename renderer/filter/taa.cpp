#include "filter/taa.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace lumi {
namespace {

constexpr int64_t kRows = 8;

/// Compressed YCoCg: y in [0, 1).
struct Compressed {
    float y = 0, co = 0, cg = 0;
};

Compressed operator*(float s, const Compressed& c) { return {s * c.y, s * c.co, s * c.cg}; }
Compressed operator+(const Compressed& a, const Compressed& b) { return {a.y + b.y, a.co + b.co, a.cg + b.cg}; }
Compressed operator-(const Compressed& a, const Compressed& b) { return {a.y - b.y, a.co - b.co, a.cg - b.cg}; }

float finiteOr0(float v) { return std::fabs(v) <= 3.402823466e38f ? v : 0.0f; }

Compressed compress(float r, float g, float b) {
    r = finiteOr0(r);
    g = finiteOr0(g);
    b = finiteOr0(b);
    const Compressed c{0.25f * r + 0.5f * g + 0.25f * b, 0.5f * (r - b), -0.25f * r + 0.5f * g - 0.25f * b};
    return (1 / (1 + std::max(c.y, 0.0f))) * c;
}

void expand(const Compressed& c, float rgb[3]) {
    const float scale = 1 / std::max(1 - c.y, 1e-6f), base = c.y - c.cg;
    rgb[0] = (base + c.co) * scale;
    rgb[1] = (c.y + c.cg) * scale;
    rgb[2] = (base - c.co) * scale;
}

Compressed load(const Image& image, int x, int y) {
    x = std::clamp(x, 0, image.width() - 1);
    y = std::clamp(y, 0, image.height() - 1);
    return {image.at(0, x, y), image.at(1, x, y), image.at(2, x, y)};
}

/// Weights of a cubic Catmull-Rom spline at fraction t between the second and third of four samples.
void catmullRom(float t, float w[4]) {
    w[0] = t * (-0.5f + t * (1 - 0.5f * t));
    w[1] = 1 + t * t * (-2.5f + 1.5f * t);
    w[2] = t * (0.5f + t * (2 - 1.5f * t));
    w[3] = t * t * (-0.5f + 0.5f * t);
}

Compressed fetch(const Image& history, float px, float py, TaaSettings::History filter) {
    const int x = static_cast<int>(std::floor(px)), y = static_cast<int>(std::floor(py));
    const float fx = px - static_cast<float>(x), fy = py - static_cast<float>(y);
    if (fx == 0 && fy == 0) return load(history, x, y);
    float wx[4] = {0, 1 - fx, fx, 0}, wy[4] = {0, 1 - fy, fy, 0};
    if (filter == TaaSettings::History::CatmullRom) {
        catmullRom(fx, wx);
        catmullRom(fy, wy);
    }
    Compressed sum;
    for (int j = 0; j < 4; ++j) {
        if (wy[j] == 0) continue;
        for (int i = 0; i < 4; ++i)
            if (wx[i] != 0) sum = sum + (wx[i] * wy[j]) * load(history, x + i - 1, y + j - 1);
    }
    return sum;
}

/// Pulls `history` towards the neighbourhood's mean until it lies within gamma standard deviations of it.
Compressed clipToNeighbourhood(const Image& compressed, int x, int y, float gamma, const Compressed& history) {
    Compressed mean, squares;
    for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) mean = mean + load(compressed, x + i, y + j);
    mean = (1.0f / 9) * mean;
    for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) {
            const Compressed d = load(compressed, x + i, y + j) - mean;
            squares = squares + Compressed{d.y * d.y, d.co * d.co, d.cg * d.cg};
        }
    const Compressed d = history - mean;
    const auto excess = [&](float offset, float square) { return std::fabs(offset) / (gamma * std::sqrt(square / 9) + 1e-6f); };
    const float most = std::max({1.0f, excess(d.y, squares.y), excess(d.co, squares.co), excess(d.cg, squares.cg)});
    return mean + (1 / most) * d;
}

/// Where the pixel was, by the motion of the nearest surface around it: silhouettes move with what is in front.
void previousPixel(const Signals& signals, int x, int y, float& px, float& py) {
    const Image& inverseDepth = signals[Signal::InverseDepth];
    int nearX = x, nearY = y;
    float nearest = inverseDepth.at(0, x, y);
    for (int j = std::max(y - 1, 0); j <= std::min(y + 1, inverseDepth.height() - 1); ++j)
        for (int i = std::max(x - 1, 0); i <= std::min(x + 1, inverseDepth.width() - 1); ++i)
            if (inverseDepth.at(0, i, j) > nearest) {
                nearest = inverseDepth.at(0, i, j);
                nearX = i;
                nearY = j;
            }
    px = static_cast<float>(x) + signals[Signal::Motion].at(0, nearX, nearY);
    py = static_cast<float>(y) + signals[Signal::Motion].at(1, nearX, nearY);
}

}  // namespace

void TaaSettings::describe(ParameterVisitor& v) {
    v.number("alpha", alpha,
             {.label = "Alpha", .min = 0.01, .max = 1, .scale = Scale::Log, .help = "Weight of the new frame [Karis14]"});
    v.choice("history-filter", history,
             {.label = "History filter",
              .options = {"bilinear", "catmull-rom"},
              .help = "How the history is read between pixels; Catmull-Rom keeps it sharp under motion"});
    v.toggle("clip", clip, {.label = "Clip history", .help = "Clip the history to the colours of the 3x3 neighbourhood"});
    v.when(clip, [&] {
        v.number("clip-gamma", gamma,
                 {.label = "Clip width",
                  .min = 0.25,
                  .max = 4,
                  .scale = Scale::Log,
                  .help = "Half the width of the clipping box in standard deviations of the neighbourhood [Salvi16]"});
    });
}

bool antialiasTemporally(const Signals& signals, const TaaSettings& settings, const Image& colour, const Image* previous,
                         Image& next, Image& out, std::stop_token stop) {
    const Extent2 extent = colour.extent();
    if (previous && previous->extent() != extent) previous = nullptr;
    Image compressed(extent, 3);
    parallelRanges(extent.area(), 1 << 14, [&](int64_t begin, int64_t end) {
        const int64_t area = extent.area();
        for (int64_t i = begin; i < end; ++i) {
            const Compressed c = compress(colour.data()[i], colour.data()[i + area], colour.data()[i + 2 * area]);
            compressed.data()[i] = c.y;
            compressed.data()[i + area] = c.co;
            compressed.data()[i + 2 * area] = c.cg;
        }
    });
    if (next.extent() != extent) next.reset(extent, 3);
    if (out.extent() != extent) out.reset(extent, 3);
    parallelRanges(extent.height, kRows, [&](int64_t begin, int64_t end) {
        for (int y = static_cast<int>(begin); y < end; ++y)
            for (int x = 0; x < extent.width; ++x) {
                Compressed result = load(compressed, x, y);
                float px = -1, py = -1;
                if (previous) previousPixel(signals, x, y, px, py);
                if (px >= 0 && py >= 0 && px <= static_cast<float>(extent.width - 1) && py <= static_cast<float>(extent.height - 1)) {
                    Compressed history = fetch(*previous, px, py, settings.history);
                    if (settings.clip) history = clipToNeighbourhood(compressed, x, y, settings.gamma, history);
                    result = history + settings.alpha * (result - history);
                }
                next.at(0, x, y) = result.y;
                next.at(1, x, y) = result.co;
                next.at(2, x, y) = result.cg;
                float rgb[3];
                expand(result, rgb);
                for (int c = 0; c < 3; ++c) out.at(c, x, y) = std::max(rgb[c], 0.0f);
            }
    }, stop);
    return !stop.stop_requested();
}

}  // namespace lumi
