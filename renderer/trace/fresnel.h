#pragma once
#include <cmath>

#include "math/vector.h"

namespace lumi {

/// (1 - cosTheta)^5, the weight of F90 in Schlick's approximation [Schlick 1994].
inline float schlickWeight(float cosTheta) {
    const float m = cosTheta < 1 ? 1 - cosTheta : 0;
    return m * m * (m * m) * m;
}

/// Reflectance of a smooth dielectric boundary for unpolarised light, exact (Fresnel). `cosI` in [0,1] is measured on
/// the incident side; `eta` is the index of the far side over that of the incident side. 1 under total reflection.
inline float fresnelDielectric(float cosI, float eta) {
    const float sin2T = (1 - cosI * cosI) / (eta * eta);
    if (sin2T >= 1) return 1;
    const float cosT = std::sqrt(1 - sin2T);
    const float parallel = (eta * cosI - cosT) / (eta * cosI + cosT);
    const float perpendicular = (cosI - eta * cosT) / (cosI + eta * cosT);
    return 0.5f * (parallel * parallel + perpendicular * perpendicular);
}

/// Direction on the far side of a boundary of unit normal `h`, for unit `w` with dot(w, h) > 0 pointing away from it
/// on the near side. False under total reflection.
inline bool refract(const Vec3& w, const Vec3& h, float eta, Vec3& refracted) {
    const float cosI = glm::dot(w, h);
    const float sin2T = (1 - cosI * cosI) / (eta * eta);
    if (sin2T >= 1) return false;
    refracted = (cosI / eta - std::sqrt(1 - sin2T)) * h - w / eta;
    return true;
}

}  // namespace lumi
