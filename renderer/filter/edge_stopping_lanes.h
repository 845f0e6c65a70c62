#pragma once
#include <array>
#include <cstddef>

#include "filter/guide_row.h"
#include "math/lanes.h"

/// Eqs. 3 and 4 of [Schied17] for the pixels of a register and the taps of a window around them. Include only from
/// kernel files: each instruction set compiles its own.
namespace lumi {
namespace {

constexpr float kLog2E = 1.44269504f;

/// Two taps across from each other, (dx, dy) and (-dx, -dy), which have eq. 3's denominator in common.
struct TapPair {
    int dx;
    std::ptrdiff_t offset;  ///< in memory
    float fx, fy;           ///< the offset again
    float logH;             ///< log2 of the window's weight
    bool plus, minus;       ///< their rows lie in the image
};

/// The pairs of a window of (2 Radius + 1)^2 taps, `step` pixels apart, around a row.
template <int Radius>
struct TapPairs {
    int count = 0;
    TapPair pairs[2 * Radius * (Radius + 1)];

    /// `logH`: log2 of the window's weight of each column and row, 2 Radius + 1 numbers.
    TapPairs(const GuideRow& row, int step, const float* logH) {
        for (int j = 0; j <= Radius; ++j)
            for (int i = j > 0 ? -Radius : 1; i <= Radius; ++i) {
                const int dx = i * step, dy = j * step;
                const bool plus = row.y + dy < row.height, minus = row.y - dy >= 0;
                if (plus || minus)
                    pairs[count++] = {dx,
                                      static_cast<std::ptrdiff_t>(dy) * row.width + dx,
                                      static_cast<float>(dx),
                                      static_cast<float>(dy),
                                      logH[i + Radius] + logH[j + Radius],
                                      plus,
                                      minus};
            }
    }
};

/// Those of a register's pixels, or of their neighbours, that lie in the image's columns.
template <bool Edge>
struct Span {
    LaneMask mask;
    LUMI_LANES Lanes load(const float* p) const { return loadPart(p, mask); }
    LUMI_LANES void store(float* p, Lanes v) const { storePart(p, mask, v); }
};
/// All of them.
template <>
struct Span<false> {
    LUMI_LANES Lanes load(const float* p) const { return loadLanes(p); }
    LUMI_LANES void store(float* p, Lanes v) const { storeLanes(p, v); }
};

/// Of the pixels from column x on, dx to the right.
template <bool Edge>
LUMI_LANES Span<Edge> spanOf(int x, int dx, int width) {
    if constexpr (!Edge) return {};
    else {
        const int left = -(x + dx), right = width - (x + dx);
        return {laneMask(left > 0 ? (left < kLanes ? left : kLanes) : 0, right < kLanes ? right : kLanes)};
    }
}

/// A tap of the pixels of a register.
template <bool Edge>
struct LaneTap {
    std::ptrdiff_t at;  ///< of the first neighbour in a plane
    Span<Edge> span;
    Lanes exponent;  ///< log2(h w_z w_n)
};

/// Where log2(cosine)'s series of degree 3 serves: from this sigma_n on it changes w_n by less than 4e-5.
constexpr float kSeriesSigma = 32;

/// What the pixels of a register from column x on are compared with. Usual: sigma_n is at least kSeriesSigma, and eq.
/// 3's numerator is as printed. Edge: some pixel or neighbour lies outside of the image's columns.
template <bool Usual, bool Edge>
class EdgeStop {
public:
    LUMI_LANES EdgeStop(const GuideRow& row, int x)
        : row_(row), x_(x), at_(static_cast<std::ptrdiff_t>(row.y) * row.width + x) {
        const Span<Edge> here = spanOf<Edge>(x, 0, row.width);
        z_ = here.load(row.inverseDepth + at_);
        slopeX_ = here.load(row.slopeX + at_);
        slopeY_ = here.load(row.slopeY + at_);
        for (int c = 0; c < 3; ++c) normal_[c] = here.load(row.normal[c] + at_);
        perRise_ = lanes(row.edges.sigmaDepth * (-1 / kLog2E));
        least_ = mulAdd(lanes(kDepthEpsilon * (-1 / kLog2E)), z_, lanes(-1e-30f));
    }

    /// Calls body(taps) with those of the two taps whose rows lie in the image, both together if they do.
    template <class Body>
    LUMI_LANES void forPair(const TapPair& pair, Body body) const {
        const Lanes rise = mulAdd(slopeX_, lanes(pair.fx), slopeY_ * lanes(pair.fy));
        const Lanes perDistance = reciprocal(mulAdd(perRise_, absolute(rise), least_)), logH = lanes(pair.logH);
        const auto tap = [&](bool plus) LUMI_LANES_LAMBDA {
            const Lanes planeRise = Usual || !row_.edges.planeDistance ? lanes(0.0f) : rise;
            return plus ? compare(pair.dx, pair.offset, z_ + planeRise, perDistance, logH)
                        : compare(-pair.dx, -pair.offset, z_ - planeRise, perDistance, logH);
        };
        if (pair.plus && pair.minus) body(std::array{tap(true), tap(false)});
        else body(std::array{tap(pair.plus)});
    }

private:
    LUMI_LANES LaneTap<Edge> compare(int dx, std::ptrdiff_t offset, Lanes expected, Lanes perDistance,
                                     Lanes logH) const {
        const Span<Edge> span = spanOf<Edge>(x_, dx, row_.width);
        const std::ptrdiff_t q = at_ + offset;
        const Lanes depth = mulAdd(distanceOf(span.load(row_.inverseDepth + q), expected), perDistance, logH);
        const Lanes nx = span.load(row_.normal[0] + q), ny = span.load(row_.normal[1] + q),
                    nz = span.load(row_.normal[2] + q);
        if constexpr (!Usual) {
            const Lanes cosine = mulAdd(normal_[0], nx, mulAdd(normal_[1], ny, normal_[2] * nz));
            return {q, span, mulAdd(lanes(row_.edges.sigmaNormal), log2OfCosine(cosine), depth)};
        }
        // log2(1 + t) = (t - t^2/2 + t^3/3) / ln 2
        const Lanes t = mulAdd(normal_[0], nx, mulAdd(normal_[1], ny, mulAdd(normal_[2], nz, lanes(-1.0f))));
        const Lanes scaled = lanes(row_.edges.sigmaNormal * kLog2E) * t;
        return {q, span, mulAdd(scaled, mulAdd(t, mulAdd(t, lanes(1.0f / 3), lanes(-0.5f)), lanes(1.0f)), depth)};
    }

    const GuideRow& row_;
    int x_;
    std::ptrdiff_t at_;
    Lanes z_, slopeX_, slopeY_, perRise_, least_, normal_[3];
};

/// Calls inner(x) for registers of a row whose neighbours up to `reach` to the side lie in the image, outer(x) for the
/// others.
template <class Inner, class Outer>
inline void forRegisters(int width, int reach, Inner inner, Outer outer) {
    int x = 0;
    for (; x < width && x < reach; x += kLanes) outer(x);
    for (; x + kLanes + reach <= width; x += kLanes) inner(x);
    for (; x < width; x += kLanes) outer(x);
}

inline bool isUsual(const EdgeStopping& edges) { return edges.sigmaNormal >= kSeriesSigma && !edges.planeDistance; }

}  // namespace
}  // namespace lumi
