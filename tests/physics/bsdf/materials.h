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

/// Integral of evaluate(wi, lobe) over the sphere by the midpoint rule: over the hemisphere for diffuse lobe and sheen, over
/// facet normals in proportion to their own distribution (not the visible one that sample() uses) for specular lobes.
Vec3 integrateLobe(const Bsdf& bsdf, const BsdfInputs& inputs, const Vec3& wo, Lobe lobe);

}  // namespace lumi::test
