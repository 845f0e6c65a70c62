#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "math/warp.h"
#include "scene/light.h"
#include "scene/sky.h"

namespace lumi {
namespace {

constexpr Extent2 kSkyExtent{512, 256};

float smooth(float a, float b, float x) {
    const float t = std::clamp((x - a) / (b - a), 0.0f, 1.0f);
    return t * t * (3 - 2 * t);
}

Vec3 directionAt(int x, int y) {
    return directionFromLatLong({(static_cast<float>(x) + 0.5f) / static_cast<float>(kSkyExtent.width),
                                 (static_cast<float>(y) + 0.5f) / static_cast<float>(kSkyExtent.height)});
}

/// Share of the sphere that a pixel of row y covers.
double pixelShare(int y) {
    const double step = 3.14159265358979323846 / kSkyExtent.height;
    return 0.5 * (std::cos(step * y) - std::cos(step * (y + 1))) / kSkyExtent.width;
}

/// Mean luminance over the sphere.
double meanLuminance(const Image& image) {
    double sum = 0;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            sum += pixelShare(y) * luminance({image.at(0, x, y), image.at(1, x, y), image.at(2, x, y)});
    return sum;
}

template <class Radiance>
Image paint(const Radiance& radiance) {
    Image image(kSkyExtent, 3);
    parallelFor(kSkyExtent.height, [&](int64_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < kSkyExtent.width; ++x) {
            const Vec3 colour = radiance(directionAt(x, y));
            for (int c = 0; c < 3; ++c) image.at(c, x, y) = colour[c];
        }
    });
    return image;
}

}  // namespace

void Sky::describe(ParameterVisitor& v) {
    v.number("radiance", radiance,
             {.label = "Radiance",
              .min = 0,
              .max = 1e5,
              .help = "Mean luminance over the whole sphere, W/(m^2 sr).",
              .redo = Redo::Build});
    v.number("sun-elevation-deg", sunElevationDeg,
             {.label = "Sun elevation",
              .min = -90,
              .max = 90,
              .unit = "deg",
              .help = "Above the horizon.",
              .redo = Redo::Build});
    v.number("sun-azimuth-deg", sunAzimuthDeg,
             {.label = "Sun azimuth",
              .min = -360,
              .max = 360,
              .unit = "deg",
              .help = "Counter-clockwise from +Z seen from above.",
              .redo = Redo::Build});
    v.number("sun-share", sunShare,
             {.label = "Sun's share",
              .min = 0,
              .max = 1,
              .help = "Of all light, the part that comes from the sun.",
              .redo = Redo::Build});
    v.number("sun-size-deg", sunSizeDeg,
             {.label = "Sun size",
              .min = 1,
              .max = 60,
              .scale = Scale::Log,
              .unit = "deg",
              .help = "Radius at which the sun has fallen to 1/e.",
              .redo = Redo::Build});
    v.colour("zenith", zenith, {.label = "Zenith", .help = "Colour overhead.", .redo = Redo::Build});
    v.colour("horizon", horizon, {.label = "Horizon", .help = "Colour above the horizon.", .redo = Redo::Build});
    v.colour("ground", ground, {.label = "Ground", .help = "Colour below the horizon.", .redo = Redo::Build});
}

Image Sky::build() const {
    Image dome = paint([&](const Vec3& d) {
        const Vec3 above = glm::mix(horizon, zenith, std::pow(std::max(d.y, 0.0f), 0.45f));
        return glm::mix(ground, above, smooth(-0.06f, 0.02f, d.y));
    });
    const float elevation = radians(sunElevationDeg), azimuth = radians(sunAzimuthDeg);
    const Vec3 sun(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                   std::cos(elevation) * std::cos(azimuth));
    const float sharpness = 1 / (1 - std::cos(radians(sunSizeDeg)));
    const Image glow =
        paint([&](const Vec3& d) { return Vec3(1.0f, 0.93f, 0.82f) * std::exp(sharpness * (glm::dot(d, sun) - 1)); });
    const double domeMean = meanLuminance(dome), glowMean = meanLuminance(glow);
    const auto domeScale = static_cast<float>(domeMean > 0 ? radiance * (1 - sunShare) / domeMean : 0);
    const auto glowScale = static_cast<float>(glowMean > 0 ? radiance * sunShare / glowMean : 0);
    for (size_t i = 0; i < dome.size(); ++i) dome.data()[i] = domeScale * dome.data()[i] + glowScale * glow.data()[i];
    return dome;
}

Image makeDefaultSky() { return Sky{}.build(); }

}  // namespace lumi
