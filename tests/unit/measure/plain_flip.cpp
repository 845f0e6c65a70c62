// FLIP [Andersson 2020] and HDR-FLIP [Andersson 2021] with whole two-dimensional filters.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "plain_definitions.h"

namespace lumi::plain {
namespace {

constexpr double kPi = 3.14159265358979323846, kPerDegree = 67.0206;
using Colour = std::array<double, 3>;
using Planes = std::array<Plane, 3>;

/// A filter over [-radius, radius]^2.
Plane filterOf(int radius, const std::function<double(int, int)>& weight) {
    Plane filter(2 * radius + 1, 2 * radius + 1);
    for (int y = -radius; y <= radius; ++y)
        for (int x = -radius; x <= radius; ++x) filter.at(x + radius, y + radius) = weight(x, y);
    return filter;
}

/// Positive weights are divided by their sum, negative ones by minus theirs.
void normalise(Plane& filter) {
    double positive = 0, negative = 0;
    for (const double v : filter.values) (v > 0 ? positive : negative) += v;
    for (double& v : filter.values) v /= v > 0 ? positive : -negative;
}

Plane filtered(const Plane& in, const Plane& filter) {
    const int radius = filter.width / 2;
    Plane out(in.width, in.height);
    for (int y = 0; y < in.height; ++y)
        for (int x = 0; x < in.width; ++x) {
            double sum = 0;
            for (int j = -radius; j <= radius; ++j)
                for (int i = -radius; i <= radius; ++i)
                    sum += filter.at(i + radius, j + radius) * in.near(x + i, y + j);
            out.at(x, y) = sum;
        }
    return out;
}

// IEC 61966-2-1 with its white point (FLIP's own digits).
Colour xyzOf(const Colour& c) {
    return {(10135552 * c[0] + 8788810 * c[1] + 4435075 * c[2]) / 24577794,
            (2613072 * c[0] + 8788810 * c[1] + 887015 * c[2]) / 12288897,
            (1425312 * c[0] + 8788810 * c[1] + 70074185 * c[2]) / 73733382};
}
const Colour kWhite = xyzOf({1, 1, 1});

/// Inverse of xyzOf by Cramer's rule.
Colour rgbOf(const Colour& xyz) {
    const Colour r = xyzOf({1, 0, 0}), g = xyzOf({0, 1, 0}), b = xyzOf({0, 0, 1});
    const auto det = [](const Colour& p, const Colour& q, const Colour& s) {
        return p[0] * (q[1] * s[2] - q[2] * s[1]) - q[0] * (p[1] * s[2] - p[2] * s[1]) +
               s[0] * (p[1] * q[2] - p[2] * q[1]);
    };
    const double whole = det(r, g, b);
    return {det(xyz, g, b) / whole, det(r, xyz, b) / whole, det(r, g, xyz) / whole};
}

Colour opponent(const Colour& rgb) {
    const Colour c = xyzOf(rgb);
    return {116 * c[1] / kWhite[1] - 16, 500 * (c[0] / kWhite[0] - c[1] / kWhite[1]),
            200 * (c[1] / kWhite[1] - c[2] / kWhite[2])};
}

/// CIELab with Hunt's adjustment of the chroma by lightness.
Colour hunt(const Colour& rgb) {
    const Colour c = xyzOf(rgb);
    const auto curve = [](double t) {
        return t > std::pow(6.0 / 29, 3) ? std::cbrt(t) : t / (3 * (6.0 / 29) * (6.0 / 29)) + 4.0 / 29;
    };
    const double x = curve(c[0] / kWhite[0]), y = curve(c[1] / kWhite[1]), z = curve(c[2] / kWhite[2]),
                 l = 116 * y - 16;
    return {l, 0.01 * l * 500 * (x - y), 0.01 * l * 200 * (y - z)};
}

double hyab(const Colour& a, const Colour& b) { return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]); }

Colour at(const Planes& planes, int x, int y) { return {planes[0].at(x, y), planes[1].at(x, y), planes[2].at(x, y)}; }

Planes mapped(const Planes& in, const std::function<Colour(const Colour&)>& f) {
    Planes out = in;
    for (int y = 0; y < in[0].height; ++y)
        for (int x = 0; x < in[0].width; ++x) {
            const Colour value = f(at(in, x, y));
            for (size_t c = 0; c < 3; ++c) out[c].at(x, y) = value[c];
        }
    return out;
}

struct Sensitivity {
    double a1, b1, a2, b2;
};

/// Colours after the contrast sensitivity filters, in Hunt-adjusted CIELab (sec. 4.1).
Planes perceived(const Planes& linear) {
    const Sensitivity table[3] = {{1, 0.0047, 0, 1e-5}, {1, 0.0053, 0, 1e-5}, {34.1, 0.04, 13.5, 0.025}};
    const int radius = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * kPi * kPi)) * kPerDegree));
    Planes planes = mapped(linear, opponent);
    for (size_t c = 0; c < 3; ++c) {
        const Sensitivity& s = table[c];
        Plane filter = filterOf(radius, [&](int x, int y) {
            const double d = (x * x + y * y) / (kPerDegree * kPerDegree);
            return s.a1 * std::sqrt(kPi / s.b1) * std::exp(-kPi * kPi * d / s.b1) +
                   s.a2 * std::sqrt(kPi / s.b2) * std::exp(-kPi * kPi * d / s.b2);
        });
        normalise(filter);
        planes[c] = filtered(planes[c], filter);
    }
    return mapped(planes, [](const Colour& c) {
        const double y = (c[0] + 16) / 116;
        Colour rgb = rgbOf({(y + c[1] / 500) * kWhite[0], y * kWhite[1], (y - c[2] / 200) * kWhite[2]});
        for (double& v : rgb) v = std::clamp(v, 0.0, 1.0);
        return hunt(rgb);
    });
}

/// Length of the gradient of edges (`second` false) or points (sec. 4.2).
Plane features(const Planes& linear, bool second) {
    const double sigma = 0.5 * 0.082 * kPerDegree;
    const int radius = static_cast<int>(std::ceil(3 * sigma));
    const auto weight = [&](int along, int across) {
        const double g = std::exp(-(along * along + across * across) / (2 * sigma * sigma));
        return second ? (along * along / (sigma * sigma) - 1) * g : -along * g;
    };
    Plane alongX = filterOf(radius, [&](int x, int y) { return weight(x, y); });
    Plane alongY = filterOf(radius, [&](int x, int y) { return weight(y, x); });
    normalise(alongX), normalise(alongY);
    Plane gray = mapped(linear, opponent)[0];
    for (double& v : gray.values) v = (v + 16) / 116;
    const Plane gx = filtered(gray, alongX), gy = filtered(gray, alongY);
    for (size_t i = 0; i < gray.values.size(); ++i) gray.values[i] = std::hypot(gx.values[i], gy.values[i]);
    return gray;
}

/// Error of each pixel of two images in linear light, in [0, 1].
Plane errorOf(const Planes& a, const Planes& b) {
    const Planes colourA = perceived(a), colourB = perceived(b);
    const Plane edgesA = features(a, false), edgesB = features(b, false), pointsA = features(a, true),
                pointsB = features(b, true);
    const double most = std::pow(hyab(hunt({0, 1, 0}), hunt({0, 0, 1})), 0.7);
    Plane out(a[0].width, a[0].height);
    for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x) {
            const double d = std::pow(hyab(at(colourA, x, y), at(colourB, x, y)), 0.7);
            const double colour =
                d < 0.4 * most ? 0.95 / (0.4 * most) * d : 0.95 + (d - 0.4 * most) / (most - 0.4 * most) * 0.05;
            const double feature =
                std::max(std::abs(edgesA.at(x, y) - edgesB.at(x, y)), std::abs(pointsA.at(x, y) - pointsB.at(x, y)));
            out.at(x, y) = std::pow(colour, 1 - std::sqrt(feature / std::sqrt(2.0)));
        }
    return out;
}

Planes planesOf(const Image& image, const std::function<double(double)>& f) {
    Planes out{Plane(image.width(), image.height()), Plane(image.width(), image.height()),
               Plane(image.width(), image.height())};
    for (int c = 0; c < 3; ++c)
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x) out[static_cast<size_t>(c)].at(x, y) = f(image.at(c, x, y));
    return out;
}

Result meanOf(Plane map, const ImagePair& pair) {
    double sum = 0, count = 0;
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x)
            if (pair.counts(x, y)) sum += map.at(x, y), ++count;
            else map.at(x, y) = 0;
    return {sum / count, std::move(map)};
}

double aces(double v) {
    v *= 0.6;
    return std::clamp(v * (2.51 * v + 0.03) / (v * (2.43 * v + 0.59) + 0.14), 0.0, 1.0);
}

/// The exposures at which ACES shows the brightest pixel and the median at 0.85, found by bisection.
std::pair<double, double> exposureRange(const Image& reference) {
    double low = 0, high = 100;
    for (int i = 0; i < 100; ++i) (aces((low + high) / 2) < 0.85 ? low : high) = (low + high) / 2;
    std::vector<double> light;
    for (int y = 0; y < reference.height(); ++y)
        for (int x = 0; x < reference.width(); ++x)
            light.push_back(0.2126 * reference.at(0, x, y) + 0.7152 * reference.at(1, x, y) +
                            0.0722 * reference.at(2, x, y));
    std::sort(light.begin(), light.end());
    const double median = (light[(light.size() - 1) / 2] + light[light.size() / 2]) / 2;
    return {std::log2(low / light.back()), std::log2(low / median)};
}

}  // namespace

Result flip(const ImagePair& pair) {
    const auto show = [factor = std::exp2(pair.exposureEv)](double v) { return std::clamp(v * factor, 0.0, 1.0); };
    return meanOf(errorOf(planesOf(pair.image, show), planesOf(pair.reference, show)), pair);
}

Result hdrFlip(const ImagePair& pair) {
    const auto [start, stop] = exposureRange(pair.reference);
    const int count = std::max(2, static_cast<int>(std::ceil(stop - start)));
    Plane worst(pair.image.width(), pair.image.height());
    for (int i = 0; i < count; ++i) {
        const double factor = std::exp2(start + (stop - start) * i / (count - 1));
        const auto show = [factor](double v) { return aces(v * factor); };
        const Plane error = errorOf(planesOf(pair.image, show), planesOf(pair.reference, show));
        for (size_t p = 0; p < worst.values.size(); ++p) worst.values[p] = std::max(worst.values[p], error.values[p]);
    }
    return meanOf(std::move(worst), pair);
}

}  // namespace lumi::plain
