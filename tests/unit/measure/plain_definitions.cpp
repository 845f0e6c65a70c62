// Metrics of pixels, SSIM, MS-SSIM and CPBD, as their papers have them.
#include "plain_definitions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

namespace lumi::plain {
namespace {

double srgb(double v) {
    v = std::clamp(v, 0.0, 1.0);
    return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
}

Plane channel(const Image& image, int c, const std::function<double(double)>& curve) {
    Plane out(image.width(), image.height());
    for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x) out.at(x, y) = curve(image.at(c, x, y));
    return out;
}

std::array<Plane, 3> shown(const Image& image, float exposureEv) {
    const auto curve = [factor = std::exp2(exposureEv)](double v) { return srgb(v * factor); };
    return {channel(image, 0, curve), channel(image, 1, curve), channel(image, 2, curve)};
}

std::array<Plane, 3> linear(const Image& image) {
    const auto same = [](double v) { return v; };
    return {channel(image, 0, same), channel(image, 1, same), channel(image, 2, same)};
}

/// Mean over the pixels that count of error(x, y).
Result meanOver(const ImagePair& pair, const std::function<double(int, int)>& error) {
    Result result{0, Plane(pair.image.width(), pair.image.height())};
    double count = 0;
    for (int y = 0; y < result.map.height; ++y)
        for (int x = 0; x < result.map.width; ++x) {
            if (!pair.counts(x, y)) continue;
            result.value += result.map.at(x, y) = error(x, y);
            ++count;
        }
    result.value /= count;
    return result;
}

Result meanOverChannels(const ImagePair& pair, const std::array<Plane, 3>& a, const std::array<Plane, 3>& b,
                        const std::function<double(double, double)>& error) {
    return meanOver(pair, [&](int x, int y) {
        double sum = 0;
        for (size_t c = 0; c < 3; ++c) sum += error(a[c].at(x, y), b[c].at(x, y)) / 3;
        return sum;
    });
}

double squared(double a, double b) { return (a - b) * (a - b); }

/// SSIM and its contrast-structure part at every window inside.
struct Windows {
    Plane ssim, contrast;
};
Windows windowsOf(const Plane& a, const Plane& b) {
    double line[11], total = 0;
    for (int k = 0; k < 11; ++k) total += line[k] = std::exp(-(k - 5) * (k - 5) / (2 * 1.5 * 1.5));
    Windows out{Plane(a.width - 10, a.height - 10), Plane(a.width - 10, a.height - 10)};
    for (int y = 0; y < out.ssim.height; ++y)
        for (int x = 0; x < out.ssim.width; ++x) {
            double ma = 0, mb = 0, aa = 0, bb = 0, ab = 0;
            for (int j = 0; j < 11; ++j)
                for (int i = 0; i < 11; ++i) {
                    const double w = line[i] * line[j] / (total * total), va = a.at(x + i, y + j),
                                 vb = b.at(x + i, y + j);
                    ma += w * va, mb += w * vb, aa += w * va * va, bb += w * vb * vb, ab += w * va * vb;
                }
            const double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;
            out.contrast.at(x, y) = (2 * (ab - ma * mb) + c2) / (aa - ma * ma + bb - mb * mb + c2);
            out.ssim.at(x, y) = (2 * ma * mb + c1) / (ma * ma + mb * mb + c1) * out.contrast.at(x, y);
        }
    return out;
}

Plane halved(const Plane& in) {
    Plane out((in.width + 1) / 2, (in.height + 1) / 2);
    for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x)
            out.at(x, y) = (in.near(2 * x, 2 * y) + in.near(2 * x + 1, 2 * y) + in.near(2 * x, 2 * y + 1) +
                            in.near(2 * x + 1, 2 * y + 1)) /
                           4;
    return out;
}

double meanOfWindows(const Plane& values, const Plane& counted) {
    double sum = 0, count = 0;
    for (int y = 0; y < values.height; ++y)
        for (int x = 0; x < values.width; ++x)
            if (counted.at(x + 5, y + 5) >= 0.5) sum += values.at(x, y), ++count;
    return sum / count;
}

Plane countedPlane(const ImagePair& pair) {
    Plane out(pair.image.width(), pair.image.height());
    for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x) out.at(x, y) = pair.counts(x, y);
    return out;
}

}  // namespace

double Plane::near(int x, int y) const { return at(std::clamp(x, 0, width - 1), std::clamp(y, 0, height - 1)); }

Result mse(const ImagePair& pair) {
    return meanOverChannels(pair, linear(pair.image), linear(pair.reference), squared);
}

Result rmse(const ImagePair& pair) {
    Result result =
        meanOverChannels(pair, shown(pair.image, pair.exposureEv), shown(pair.reference, pair.exposureEv), squared);
    result.value = std::sqrt(result.value);
    for (double& v : result.map.values) v = std::sqrt(v);
    return result;
}

Result psnr(const ImagePair& pair) {
    Result result =
        meanOverChannels(pair, shown(pair.image, pair.exposureEv), shown(pair.reference, pair.exposureEv), squared);
    result.value = -10 * std::log10(result.value);
    return result;
}

Result mae(const ImagePair& pair) {
    return meanOverChannels(pair, linear(pair.image), linear(pair.reference),
                            [](double a, double b) { return std::abs(a - b); });
}

Result smape(const ImagePair& pair) {
    return meanOverChannels(pair, linear(pair.image), linear(pair.reference), [](double a, double b) {
        return 2 * std::abs(a - b) / (std::abs(a) + std::abs(b) + 0.01);
    });
}

Result relmse(const ImagePair& pair) {
    const auto a = linear(pair.image), b = linear(pair.reference);
    return meanOver(pair, [&](int x, int y) {
        double sum = 0, gray = 0;
        for (size_t c = 0; c < 3; ++c) sum += squared(a[c].at(x, y), b[c].at(x, y)), gray += b[c].at(x, y) / 3;
        return sum / (gray * gray + pair.settings.relMseEpsilon);
    });
}

Result ssim(const ImagePair& pair) {
    const auto a = shown(pair.image, pair.exposureEv), b = shown(pair.reference, pair.exposureEv);
    Result result{0, Plane(pair.image.width(), pair.image.height())};
    for (size_t c = 0; c < 3; ++c) {
        const Windows windows = windowsOf(a[c], b[c]);
        result.value += meanOfWindows(windows.ssim, countedPlane(pair)) / 3;
        for (int y = 0; y < windows.ssim.height; ++y)
            for (int x = 0; x < windows.ssim.width; ++x)
                if (pair.counts(x + 5, y + 5)) result.map.at(x + 5, y + 5) += (1 - windows.ssim.at(x, y)) / 3;
    }
    return result;
}

Result msSsim(const ImagePair& pair) {
    const double exponents[] = {0.0448, 0.2856, 0.3001, 0.2363, 0.1333};
    const auto first = shown(pair.image, pair.exposureEv), second = shown(pair.reference, pair.exposureEv);
    const Plane counts = countedPlane(pair);
    Result result{0, Plane(counts.width, counts.height)};
    for (size_t c = 0; c < 3; ++c) {
        Plane a = first[c], b = second[c], counted = counts, local(counts.width, counts.height);
        std::fill(local.values.begin(), local.values.end(), 1.0);
        double product = 1;
        for (int scale = 0; scale < 5; ++scale) {
            const Windows windows = windowsOf(a, b);
            const Plane& values = scale < 4 ? windows.contrast : windows.ssim;
            product *= std::pow(std::max(meanOfWindows(values, counted), 0.0), exponents[scale]);
            for (int y = 0; y < local.height; ++y)  // the window around the pixel, or the nearest one inside
                for (int x = 0; x < local.width; ++x)
                    local.at(x, y) *=
                        std::pow(std::max(values.near((x >> scale) - 5, (y >> scale) - 5), 0.0), exponents[scale]);
            a = halved(a), b = halved(b), counted = halved(counted);
        }
        result.value += product / 3;
        for (size_t i = 0; i < local.values.size(); ++i)
            if (counts.values[i] > 0) result.map.values[i] += (1 - local.values[i]) / 3;
    }
    return result;
}

Result cpbd(const ImagePair& pair) {
    const auto rgb = shown(pair.image, pair.exposureEv);
    const int w = pair.image.width(), h = pair.image.height();
    Plane gray(w, h), strength(w, h);
    for (size_t i = 0; i < gray.values.size(); ++i)
        gray.values[i] =
            std::round(255 * (0.299 * rgb[0].values[i] + 0.587 * rgb[1].values[i] + 0.114 * rgb[2].values[i]));
    for (int y = 1; y < h - 1; ++y)
        for (int x = 1; x < w - 1; ++x) {
            double slope = 0;
            for (int j = -1; j <= 1; ++j)
                slope += (j == 0 ? 2 : 1) * (gray.at(x + 1, y + j) - gray.at(x - 1, y + j)) / 8;
            strength.at(x, y) = slope * slope;
        }
    const auto isEdge = [&](int x, int y) {
        if (x <= 0 || y <= 0 || x >= w - 1 || y >= h - 1) return false;
        const double right = gray.at(x + 1, y) - gray.at(x - 1, y), down = gray.at(x, y + 1) - gray.at(x, y - 1);
        const double degrees = right == 0 ? 0 : std::atan2(std::abs(down), std::abs(right)) * 180 / std::numbers::pi;
        return strength.at(x, y) > 4 && strength.at(x, y) > strength.at(x - 1, y) &&
               strength.at(x, y) >= strength.at(x + 1, y) && degrees < 22.5;
    };
    const auto reach = [&](int x, int y, int step, double sign) {
        for (int k = 0;; ++k) {
            const int near = x + step * (1 + k), far = near + step;
            if (k == 100 || far < 0 || far >= w || sign * (gray.at(far, y) - gray.at(near, y)) <= 0) return k + 1;
        }
    };
    double edges = 0, sharp = 0;
    Plane map(w, h);
    for (int by = 0; by < h; by += 64)
        for (int bx = 0; bx < w; bx += 64) {
            const int x1 = std::min(bx + 64, w), y1 = std::min(by + 64, h);
            double found = 0, low = 255, high = 0;
            for (int y = by; y < y1; ++y)
                for (int x = bx; x < x1; ++x)
                    found += isEdge(x, y), low = std::min(low, gray.at(x, y)), high = std::max(high, gray.at(x, y));
            if (found <= 0.002 * (x1 - bx) * (y1 - by)) continue;
            for (int y = by; y < y1; ++y)
                for (int x = bx; x < x1; ++x) {
                    if (!isEdge(x, y) || !pair.counts(x, y)) continue;
                    const double rise = gray.at(x + 1, y) >= gray.at(x - 1, y) ? 1 : -1;
                    const int width = reach(x, y, 1, rise) + reach(x, y, -1, -rise);
                    ++edges;
                    map.at(x, y) = 1 - std::exp(-std::pow(width / (high - low <= 50 ? 5.0 : 3.0), 3.6));
                    sharp += static_cast<int>(100 * map.at(x, y) + 0.5) <= 63;
                }
        }
    return {edges > 0 ? sharp / edges : 0, map};
}

}  // namespace lumi::plain
