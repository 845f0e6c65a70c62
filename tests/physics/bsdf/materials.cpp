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
        add("specular-glossiness silver", [&](BsdfInputs& i) {
            i.baseColor = Vec3(0.05f, 0.04f, 0.03f), i.specularColor = Vec3(0.97f, 0.96f, 0.9f) / 0.04f;
        });
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
        for (const bool entering : {true, false})
            add(entering ? "weak red glass from outside" : "weak red glass from inside", [&](BsdfInputs& i) {
                i.transmission = 1, i.solid = true, i.entering = entering;
                i.specular = 0.5f, i.specularColor = Vec3(1, 0.2f, 0.2f), i.multipleScattering = true;
            });
        add("weak thin wall of a strong colour", [&](BsdfInputs& i) {
            i.transmission = 0.9f, i.specular = 0.5f, i.specularColor = Vec3(10, 10, 4), i.multipleScattering = true;
        });
        for (const char* name :
             {"white metal", "gold", "white plastic", "thin wall", "tinted thin wall", "glass from outside",
              "glass from inside", "bubble from outside", "tinted half glass"}) {
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
        layered("red plastic, a rough varnish with bumps of its own", [&](BsdfInputs& i, LayerInputs& l) {
            i.baseColor = red, l.clearcoat = 0.9f, l.clearcoatRoughness = 0.3f;
            l.clearcoatNormal = glm::normalize(Vec3(0.3f, -0.2f, 1));
        });
        layered("gold, a varnish that leans away", [&](BsdfInputs& i, LayerInputs& l) {
            i.metallic = 1, i.baseColor = gold, l.clearcoat = 1, l.clearcoatRoughness = 0.25f;
            l.clearcoatNormal = glm::normalize(Vec3(-0.3f, 0.2f, 1));
        });
        layered("smooth varnish with bumps of its own", [&](BsdfInputs&, LayerInputs& l) {
            l.clearcoat = 1, l.clearcoatNormal = glm::normalize(Vec3(0.5f, 0.1f, 1));
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
        layered("brushed white plastic", [&](BsdfInputs& i, LayerInputs& l) {
            i.multipleScattering = true, l.anisotropy = 0.9f, l.anisotropyDirection = {0.8f, 0.6f};
        });
        for (const bool entering : {true, false})
            layered(entering ? "brushed glass from outside" : "brushed glass from inside",
                    [&](BsdfInputs& i, LayerInputs& l) {
                        i.transmission = 1, i.solid = true, i.entering = entering, i.multipleScattering = true;
                        l.anisotropy = 0.6f;
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
            i.multipleScattering = true;
        });
        layered("iridescent glass", [&](BsdfInputs& i, LayerInputs& l) {
            i.transmission = 1, i.solid = true, l.iridescence = 0.8f, l.iridescenceThickness = 250;
            i.multipleScattering = true;
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

glm::dvec3 coatNormal(const BsdfInputs& inputs, const Vec3& wo) {
    const Vec3& normal = inputs.layers.clearcoatNormal;
    return glm::dot(normal, wo) > 0 ? glm::dvec3(normal) : glm::dvec3(0, 0, 1);
}

Facets::Facets(const BsdfInputs& inputs, Lobe lobe, const Vec3& wo) {
    if (lobe == Lobe::Clearcoat) {
        const glm::dvec3 z = coatNormal(inputs, wo);
        const glm::dvec3 x = glm::normalize(glm::cross(glm::dvec3(0, 1, 0), z));
        axes_ = glm::dmat3(x, glm::cross(z, x), z);
    }
    const float roughness = lobe == Lobe::Clearcoat ? inputs.layers.clearcoatRoughness : inputs.roughness;
    alpha_ = sqr(double(std::max(roughness, Bsdf::kDeltaRoughness)));
    const bool stretched = inputs.layered && inputs.layers.anisotropy > 0 && lobe != Lobe::Clearcoat;
    along_ = stretched ? (alpha_ + (1 - alpha_) * sqr(double(inputs.layers.anisotropy))) / alpha_ : 1;
    turn_ = std::atan2(inputs.layers.anisotropyDirection.y, inputs.layers.anisotropyDirection.x);
}

glm::dvec3 Facets::at(double steeper, double phi, double& density) const {
    // tan^2 = alpha^2 u / (1 - u) spreads normals as alpha^2 / (pi cos^3 (alpha^2 + tan^2)^2) a solid angle.
    const double alpha2 = alpha_ * alpha_, tan2 = alpha2 * (1 - steeper) / steeper;
    const double cosH = 1 / std::sqrt(1 + tan2), sinH = std::sqrt(tan2) * cosH;
    glm::dvec3 h(sinH * std::cos(phi), sinH * std::sin(phi), cosH);
    density = alpha2 / (M_PI * cosH * cosH * cosH * sqr(alpha2 + tan2));
    if (along_ == 1) return axes_ * h;
    // Slopes stretched along x spread the density over as much more of them.
    const double slopeX = h.x / h.z * along_, slopeY = h.y / h.z, c = std::cos(turn_), s = std::sin(turn_);
    h = glm::normalize(glm::dvec3(slopeX * c - slopeY * s, slopeX * s + slopeY * c, 1));
    density *= cosH * cosH * cosH / (along_ * h.z * h.z * h.z);
    return h;
}

Vec2 Facets::find(const glm::dvec3& h) const {
    const double c = std::cos(turn_), s = std::sin(turn_), slopeX = (h.x * c + h.y * s) / h.z / along_,
                 slopeY = (h.y * c - h.x * s) / h.z, alpha2 = alpha_ * alpha_;
    const double phi = std::atan2(slopeY, slopeX);
    return Vec2(alpha2 / (alpha2 + slopeX * slopeX + slopeY * slopeY), phi < 0 ? phi + 2 * M_PI : phi);
}

namespace {

/// value(wi) over the upper hemisphere (`side` 1) or the lower one (-1).
template <class Value>
Vec3 integrateHemisphere(int rings, int sectors, float side, const Value& value) {
    glm::dvec3 sum(0);
    for (int i = 0; i < rings; ++i)
        for (int j = 0; j < sectors; ++j) {
            // Even in the root of the cosine: the layer above the diffuse base changes fastest at grazing angles.
            const double x = (i + 0.5) / rings, z = x * x, phi = 2 * M_PI * (j + 0.5) / sectors;
            const double r = std::sqrt(1 - z * z);
            const Vec3 wi(static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)),
                          static_cast<float>(z) * side);
            sum += 2 * x * glm::dvec3(value(wi));
        }
    return Vec3(sum * (2 * M_PI / (double(rings) * sectors)));
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

Vec3 integrateFacets(const Bsdf& once, const BsdfInputs& inputs, const Vec3& wo, Lobe lobe, int rings, int sectors) {
    const Facets facets(inputs, lobe, wo);
    glm::dvec3 sum(0);
    for (int i = 0; i < rings; ++i)
        for (int j = 0; j < sectors; ++j) {
            const double t = (i + 0.5) / rings;
            double density;
            const glm::dvec3 h = facets.at(t * t, 2 * M_PI * (j + 0.5) / sectors, density);
            glm::dvec3 wi;
            const double solidAngle = scattered(wo, h, lobe, inputs, wi);
            if (solidAngle > 0) sum += glm::dvec3(once.evaluate(Vec3(wi), lobe)) * (2 * t * solidAngle / density);
        }
    return Vec3(sum / (double(rings) * sectors));
}

}  // namespace

LobeIntegral integrateLobe(const Bsdf& bsdf, const BsdfInputs& inputs, const Vec3& wo, Lobe lobe) {
    BsdfInputs plain = inputs;
    plain.multipleScattering = false;
    const Bsdf once(plain, wo);
    // Facets much flatter than the highlight is long turn fast about it.
    const bool stretched = inputs.layered && inputs.layers.anisotropy > 0;
    // And where total reflection begins there is a kink, with a vertical tangent on one side.
    const bool kinked = inputs.solid && inputs.entering == (inputs.ior < 1);
    const int density = stretched ? 12 : kinked ? 4 : 1;
    const auto by = [&](int rings, int sectors) {
        if (lobe == Lobe::Diffuse || lobe == Lobe::Sheen)
            return integrateHemisphere(rings, sectors, 1, [&](const Vec3& wi) { return bsdf.evaluate(wi, lobe); });
        Vec3 sum = integrateFacets(once, inputs, wo, lobe, rings * (kinked ? 2 : 1), sectors * density);
        if (inputs.multipleScattering && lobe != Lobe::Clearcoat)
            sum += integrateHemisphere(rings / 2, 8, lobe == Lobe::SpecularTransmission ? -1 : 1, [&](const Vec3& wi) {
                return bsdf.evaluate(wi, lobe) - once.evaluate(wi, lobe);
            });
        return sum;
    };
    const Vec3 fine = by(180, 64), coarse = by(90, 32);
    return {fine, maxComponent(glm::abs(fine - coarse))};
}

}  // namespace lumi::test
