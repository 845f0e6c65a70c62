#pragma once
#include "math/vector.h"

namespace lumi {

/// Reflectance of a surface under a film thin enough to show colours of interference, for unpolarised light, as linear
/// Rec.709 [Belcour & Barla 2017, "A Practical Extension to Microfacet Theory for the Modeling of Varying
/// Iridescence"]: an Airy sum of three terms whose spectra are integrated in closed form. In [0,1].
/// The film lies in air; interfaces follow Schlick.
class ThinFilm {
public:
    ThinFilm() = default;
    /// `nanometres` of film of index `ior` on a base that reflects `baseF0` in air at normal incidence. Below 10 nm it
    /// fades: at 0 the base alone is left.
    ThinFilm(float ior, float nanometres, const Vec3& baseF0);

    Vec3 reflectance(float cosTheta) const;
    /// Mean over the hemisphere weighted by the cosine.
    Vec3 averageReflectance() const;

private:
    float ior_ = 1, thickness_ = 0;
    float presence_ = 0;  ///< 1 of all but the thinnest films
    Vec3 baseF0_{0};      ///< of the base in air
    float filmF0_ = 0;    ///< of the film's upper face
    Vec3 innerF0_{0};     ///< of the base seen from inside the film
    Vec3 phase_{0};       ///< by which both reflections inside the film shift the wave
};

}  // namespace lumi
