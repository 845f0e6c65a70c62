#pragma once
#include <functional>
#include <string>
#include <vector>

#include "trace/bsdf.h"

namespace lumi::test {

struct NamedMaterial {
    std::string name;
    BsdfInputs inputs;
};

/// One of each kind: Lambert, plastic, coloured specular, metals, thin walls, solids from both sides, mixtures, and
/// each layer. Layers keep their own roughness whatever forEachBsdf() sets.
const std::vector<NamedMaterial>& materials();

/// Unit direction in the x-z plane, turned a little about z.
Vec3 directionAt(float cosTheta);

/// Calls check(bsdf, label) for each material, roughness and cosine.
void forEachBsdf(const std::vector<float>& roughnesses, const std::vector<float>& cosines,
                 const std::function<void(const Bsdf&, const BsdfInputs&, const Vec3& wo, const std::string&)>& check);

constexpr Lobe kLobes[] = {Lobe::Diffuse, Lobe::SpecularReflection, Lobe::SpecularTransmission, Lobe::Clearcoat,
                           Lobe::Sheen};
constexpr int kLobeCount = 5;

/// Of the varnish seen along wo: its own, or the surface's if that faces away.
glm::dvec3 coatNormal(const BsdfInputs& inputs, const Vec3& wo);

/// Normals of a lobe's facets as its distribution spreads them, not as sample() sees them.
class Facets {
public:
    /// `wo` chooses the normal of a clearcoat's.
    Facets(const BsdfInputs& inputs, Lobe lobe, const Vec3& wo = Vec3(0, 0, 1));
    /// The normal at azimuth `phi` (before stretching) that a share `steeper` in (0,1] of facets is steeper than, and
    /// how much of (share, azimuth over a turn) a solid angle there holds.
    glm::dvec3 at(double steeper, double phi, double& density) const;
    /// The reverse: (steeper, phi in [0, 2 pi]).
    Vec2 find(const glm::dvec3& h) const;

private:
    double alpha_, along_, turn_;
    glm::dmat3 axes_{1};  ///< of the normal about which they lie, as columns
};

/// Integral of evaluate(wi, lobe) over the sphere.
struct LobeIntegral {
    Vec3 value{0};
    float error = 0;  ///< by how much it changes when every other ring and sector is left out
};

/// By the midpoint rule: over the hemisphere for diffuse lobe, sheen and what facets scatter more than once; over facet
/// normals in proportion to their own distribution (not the visible one that sample() uses) for what they scatter once.
LobeIntegral integrateLobe(const Bsdf& bsdf, const BsdfInputs& inputs, const Vec3& wo, Lobe lobe);

}  // namespace lumi::test
