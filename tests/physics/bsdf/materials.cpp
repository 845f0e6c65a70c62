#include "physics/bsdf/materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lumi::test {

const std::vector<NamedMaterial>& materials() {
    static const std::vector<NamedMaterial> all = [] {
        const Vec3 white(1), red(0.9f, 0.2f, 0.1f), gold(1.0f, 0.77f, 0.34f);
        std::vector<NamedMaterial> list;
        const auto add = [&](const char* name, auto change) {
            BsdfInputs inputs;
            inputs.baseColor = white;
            change(inputs);
            list.push_back({name, inputs});
        };
        add("lambert", [&](BsdfInputs& i) { i.specular = 0, i.baseColor = red; });
        add("white plastic", [&](BsdfInputs&) {});
        add("dense plastic", [&](BsdfInputs& i) { i.ior = 2.4f, i.baseColor = red; });
        add("tinted specular", [&](BsdfInputs& i) { i.specularColor = Vec3(8, 2, 0.5f), i.specular = 0.8f; });
        add("white metal", [&](BsdfInputs& i) { i.metallic = 1; });
        add("gold", [&](BsdfInputs& i) { i.metallic = 1, i.baseColor = gold; });
        add("half metal", [&](BsdfInputs& i) { i.metallic = 0.5f, i.baseColor = gold; });
        add("thin wall", [&](BsdfInputs& i) { i.transmission = 1; });
        add("tinted thin wall", [&](BsdfInputs& i) { i.transmission = 0.7f, i.baseColor = red, i.metallic = 0.2f; });
        add("glass from outside", [&](BsdfInputs& i) { i.transmission = 1, i.solid = true; });
        add("glass from inside", [&](BsdfInputs& i) { i.transmission = 1, i.solid = true, i.entering = false; });
        add("bubble from outside", [&](BsdfInputs& i) { i.transmission = 1, i.solid = true, i.ior = 0.75f; });
        add("tinted half glass",
            [&](BsdfInputs& i) { i.transmission = 0.5f, i.solid = true, i.baseColor = red, i.ior = 1.33f; });
        for (const char* name : {"white metal", "gold", "white plastic", "thin wall", "tinted half glass"}) {
            const auto same = [&](const NamedMaterial& m) { return m.name == name; };
            NamedMaterial many = *std::find_if(list.begin(), list.end(), same);
            many.name += ", many bounces";
            many.inputs.multipleScattering = true;
            list.push_back(many);
        }
        const auto layered = [&](const char* name, auto change) {
            add(name, [&](BsdfInputs& i) { i.layered = true, change(i, i.layers); });
        };
        layered("varnished plastic", [&](BsdfInputs&, LayerInputs& l) { l.clearcoat = 1; });
        layered("roughly varnished gold", [&](BsdfInputs& i, LayerInputs& l) {
            i.metallic = 1, i.baseColor = gold, l.clearcoat = 0.8f, l.clearcoatRoughness = 0.3f;
        });
        layered("red velvet", [&](BsdfInputs& i, LayerInputs& l) {
            i.baseColor = red, l.sheenColor = {0.9f, 0.5f, 0.3f}, l.sheenRoughness = 0.3f;
        });
        layered("white wool", [&](BsdfInputs&, LayerInputs& l) { l.sheenColor = white, l.sheenRoughness = 0.8f; });
        layered("silk under varnish", [&](BsdfInputs& i, LayerInputs& l) {
            i.transmission = 0.3f, l.sheenColor = gold, l.sheenRoughness = 0.2f, l.clearcoat = 0.5f;
            l.clearcoatRoughness = 0.1f;
        });
        layered("brushed metal", [&](BsdfInputs& i, LayerInputs& l) {
            i.metallic = 1, i.multipleScattering = true, l.anisotropy = 0.7f, l.anisotropyDirection = {0.6f, -0.8f};
        });
        layered("brushed plastic", [&](BsdfInputs& i, LayerInputs& l) {
            i.baseColor = red, l.anisotropy = 0.4f, l.anisotropyDirection = {-1, 3};
        });
        layered("iridescent metal", [&](BsdfInputs& i, LayerInputs& l) {
            i.metallic = 1, i.baseColor = gold, l.iridescence = 1, l.iridescenceThickness = 450;
            i.multipleScattering = true;
        });
        layered("iridescent plastic", [&](BsdfInputs&, LayerInputs& l) {
            l.iridescence = 0.7f, l.iridescenceIor = 1.8f, l.iridescenceThickness = 300;
        });
        layered("soap bubble", [&](BsdfInputs& i, LayerInputs& l) {
            i.transmission = 1, l.iridescence = 1, l.iridescenceIor = 1.33f, l.iridescenceThickness = 600;
        });
        layered("iridescent glass", [&](BsdfInputs& i, LayerInputs& l) {
            i.transmission = 1, i.solid = true, l.iridescence = 0.8f, l.iridescenceThickness = 250;
        });
        return list;
    }();
    return all;
}

Vec3 directionAt(float cosTheta) {
    const float s = std::sqrt(1 - cosTheta * cosTheta);
    return {s * std::cos(0.4f), s * std::sin(0.4f), cosTheta};
}

void forEachBsdf(const std::vector<float>& roughnesses, const std::vector<float>& cosines,
                 const std::function<void(const Bsdf&, const BsdfInputs&, const Vec3&, const std::string&)>& check) {
    for (const NamedMaterial& material : materials())
        for (const float roughness : roughnesses)
            for (const float cosTheta : cosines) {
                BsdfInputs inputs = material.inputs;
                inputs.roughness = roughness;
                const Vec3 wo = directionAt(cosTheta);
                check(Bsdf(inputs, wo), inputs, wo,
                      fmt::format("{}, roughness {}, cosine {}", material.name, roughness, cosTheta));
            }
}

namespace {

constexpr int kRings = 180, kSectors = 64;

Vec3 integrateHemisphere(const Bsdf& bsdf, Lobe lobe) {
    glm::dvec3 sum(0);
    for (int i = 0; i < kRings; ++i)
        for (int j = 0; j < kSectors; ++j) {
            // Even in the root of the cosine: the layer above the diffuse base changes fastest at grazing angles.
            const double x = (i + 0.5) / kRings, z = x * x, phi = 2 * M_PI * (j + 0.5) / kSectors;
            const double r = std::sqrt(1 - z * z);
            const Vec3 wi(static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)),
                          static_cast<float>(z));
            sum += 2 * x * glm::dvec3(bsdf.evaluate(wi, lobe));
        }
    return Vec3(sum * (2 * M_PI / (kRings * kSectors)));
}

/// Direction that facet h makes of wo, and the solid angle it covers for one of h; 0 if there is none.
double scattered(const glm::dvec3& wo, const glm::dvec3& h, Lobe lobe, const BsdfInputs& inputs, glm::dvec3& wi) {
    const double c = glm::dot(wo, h);
    if (c <= 0) return 0;
    if (lobe != Lobe::SpecularTransmission || !inputs.solid) {
        wi = 2 * c * h - wo;
        if (wi.z <= 0) return 0;
        if (lobe == Lobe::SpecularTransmission) wi.z = -wi.z;
        return 4 * c;
    }
    const double eta = inputs.entering ? inputs.ior : 1.0 / inputs.ior;
    const double sin2 = (1 - c * c) / (eta * eta);
    if (sin2 >= 1) return 0;
    wi = (c / eta - std::sqrt(1 - sin2)) * h - wo / eta;
    if (wi.z >= 0) return 0;
    const double ci = -glm::dot(wi, h);
    return (eta * ci - c) * (eta * ci - c) / (eta * eta * ci);
}

}  // namespace

Vec3 integrateLobe(const Bsdf& bsdf, const BsdfInputs& inputs, const Vec3& wo, Lobe lobe) {
    if (lobe == Lobe::Diffuse || lobe == Lobe::Sheen) return integrateHemisphere(bsdf, lobe);
    const float roughness = lobe == Lobe::Clearcoat ? inputs.layers.clearcoatRoughness : inputs.roughness;
    const double alpha = double(roughness) * roughness;
    const bool stretched = inputs.layered && inputs.layers.anisotropy > 0 && lobe != Lobe::Clearcoat;
    const double along = stretched ? (alpha + (1 - alpha) * sqr(inputs.layers.anisotropy)) / alpha : 1;
    const double turn = std::atan2(inputs.layers.anisotropyDirection.y, inputs.layers.anisotropyDirection.x);
    glm::dvec3 sum(0);
    for (int i = 0; i < kRings; ++i)
        for (int j = 0; j < kSectors; ++j) {
            // tan^2 = alpha^2 u / (1 - u) spreads normals as alpha^2 / (pi cos^3 (alpha^2 + tan^2)^2) a solid angle.
            const double t = (i + 0.5) / kRings, oneMinusU = t * t, u = 1 - oneMinusU;
            const double tan2 = alpha * alpha * u / oneMinusU, phi = 2 * M_PI * (j + 0.5) / kSectors;
            const double cosH = 1 / std::sqrt(1 + tan2), sinH = std::sqrt(tan2) * cosH;
            glm::dvec3 h(sinH * std::cos(phi), sinH * std::sin(phi), cosH);
            double density =
                alpha * alpha / (M_PI * cosH * cosH * cosH * (alpha * alpha + tan2) * (alpha * alpha + tan2));
            if (stretched) {
                // Slopes stretched along x spread the density over as much more of them.
                const double slopeX = h.x / h.z * along, slopeY = h.y / h.z;
                h = glm::normalize(glm::dvec3(slopeX * std::cos(turn) - slopeY * std::sin(turn),
                                              slopeX * std::sin(turn) + slopeY * std::cos(turn), 1));
                density *= cosH * cosH * cosH / (along * h.z * h.z * h.z);
            }
            glm::dvec3 wi;
            const double solidAngle = scattered(wo, h, lobe, inputs, wi);
            if (solidAngle > 0) sum += glm::dvec3(bsdf.evaluate(Vec3(wi), lobe)) * (2 * t * solidAngle / density);
        }
    return Vec3(sum / double(kRings * kSectors));
}

}  // namespace lumi::test
