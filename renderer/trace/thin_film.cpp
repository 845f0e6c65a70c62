#include "trace/thin_film.h"

#include <algorithm>
#include <cmath>

#include "trace/fresnel.h"

namespace lumi {
namespace {

/// A thinner film, in nm, fades to none: the sum of three terms is no good for it.
constexpr float kWholeFilm = 10;

float reflectanceOf(float ratio) { return sqr((ratio - 1) / (ratio + 1)); }

/// Index of a dielectric of this reflectance in air.
float indexOf(float f0) {
    const float root = std::sqrt(std::clamp(f0, 0.0f, 0.9999f));
    return (1 + root) / (1 - root);
}

/// Fourier transform of the colour matching functions, each a Gaussian (X two) over wave numbers, at an optical path
/// difference in metres. XYZ of a white spectrum at 0.
Vec3 sensitivity(float pathDifference, const Vec3& shift) {
    constexpr double kNormal = 1.0685e-7;
    static const Vec3 kPosition(1.6810e6f, 1.7953e6f, 2.2084e6f), kVariance(4.3278e9f, 9.3046e9f, 6.6121e9f);
    static const double kTwoPi = 2 * M_PI;
    static const Vec3 kHeight(static_cast<float>(5.4856e-13 * std::sqrt(kTwoPi * 4.3278e9) / kNormal),
                              static_cast<float>(4.4201e-13 * std::sqrt(kTwoPi * 9.3046e9) / kNormal),
                              static_cast<float>(5.2481e-13 * std::sqrt(kTwoPi * 6.6121e9) / kNormal));
    static const float kSecondX = static_cast<float>(9.7470e-14 * std::sqrt(kTwoPi * 4.5282e9) / kNormal);
    const float phase = 2 * kPi * pathDifference, square = phase * phase;
    Vec3 xyz = kHeight * glm::cos(kPosition * phase + shift) * glm::exp(-kVariance * square);
    xyz.x += kSecondX * std::cos(2.2399e6f * phase + shift.x) * std::exp(-4.5282e9f * square);
    return xyz;
}

/// CIE 1931 XYZ to Rec.709 primaries.
Vec3 rec709(const Vec3& c) {
    return {3.2404542f * c.x - 1.5371385f * c.y - 0.4985314f * c.z,
            -0.9692660f * c.x + 1.8760108f * c.y + 0.0415560f * c.z,
            0.0556434f * c.x - 0.2040259f * c.y + 1.0572252f * c.z};
}

}  // namespace

ThinFilm::ThinFilm(float ior, float nanometres, const Vec3& baseF0)
    : ior_(std::max(ior, 1.0f)), thickness_(std::max(nanometres, 0.0f)), baseF0_(baseF0) {
    const float t = std::min(thickness_ / kWholeFilm, 1.0f);
    presence_ = t * t * (3 - 2 * t);
    filmF0_ = reflectanceOf(ior_);
    for (int c = 0; c < 3; ++c) {
        const float index = indexOf(baseF0[c]);
        innerF0_[c] = reflectanceOf(index / ior_);
        // The film's upper face shifts by nothing from within; a denser base by half a wave.
        phase_[c] = kPi + (index < ior_ ? kPi : 0);
    }
}

Vec3 ThinFilm::reflectance(float cosTheta) const {
    const Vec3 bare = baseF0_ + (Vec3(1) - baseF0_) * schlickWeight(cosTheta);
    if (presence_ == 0) return bare;
    const float cos2 = 1 - (1 - cosTheta * cosTheta) / (ior_ * ior_);
    if (cos2 <= 0) return Vec3(1);
    const float inner = std::sqrt(cos2);
    const float upper = filmF0_ + (1 - filmF0_) * schlickWeight(cosTheta), passed = 1 - upper;
    const Vec3 lower = innerF0_ + (Vec3(1) - innerF0_) * schlickWeight(inner);
    const Vec3 both = glm::clamp(upper * lower, Vec3(1e-5f), Vec3(0.9999f)), amplitude = glm::sqrt(both);
    const Vec3 incoherent = sqr(passed) * lower / (Vec3(1) - both);

    const float pathDifference = 2e-9f * ior_ * thickness_ * inner;
    Vec3 sum = Vec3(upper) + incoherent, order = incoherent - Vec3(passed);
    for (int m = 1; m <= 2; ++m) {
        order *= amplitude;
        sum +=
            order * 2.0f * rec709(sensitivity(static_cast<float>(m) * pathDifference, static_cast<float>(m) * phase_));
    }
    return bare + (glm::clamp(sum, Vec3(0), Vec3(1)) - bare) * presence_;
}

Vec3 ThinFilm::averageReflectance() const {
    // Gauss's rule of three points in each quarter of the cosine. From grazing to upright the path difference of a film
    // of index n and thickness d changes by 2 d (n - sqrt(n^2 - 1)): of 1 um and index 1.3 by less than three waves of
    // blue light, twice that in the second order, so that a quarter sees one and a half at most.
    const float offset = 0.5f * std::sqrt(0.6f);
    Vec3 sum(0);
    for (int quarter = 0; quarter < 4; ++quarter)
        for (int point = -1; point <= 1; ++point) {
            const float c = 0.25f * (static_cast<float>(quarter) + 0.5f + offset * static_cast<float>(point));
            sum += (point == 0 ? 4.0f / 9 : 5.0f / 18) * 0.25f * 2 * c * reflectance(c);
        }
    return glm::min(sum, Vec3(1));
}

}  // namespace lumi
