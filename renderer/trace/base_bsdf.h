#pragma once
#include "trace/albedo_table.h"
#include "trace/boundary_fresnel.h"
#include "trace/bsdf_inputs.h"
#include "trace/dielectric_albedo.h"
#include "trace/ggx.h"
#include "trace/thin_film.h"

namespace lumi {

/// The scattering function below all layers at one point for one outgoing direction, in the local frame (z is the
/// shading normal on wo's side, wo.z > 0; x is the direction of anisotropy). Lobes:
///   diffuse: Lambert under the specular layer, weighted by what that layer lets through,
///     f = rho/pi (1 - E(wo)) (1 - E(wi)) / (1 - Eavg)  [Kelemen & Szirmay-Kalos 2001],
///     rho = baseColor (1-metallic)(1-transmission);
///   specular reflection: GGX with visible normals [Heitz 2018], Schlick Fresnel from ior, specular, specularColor and
///     (metals) baseColor; where the base transmits, the exact dielectric term in its place, weighted alike on both
///     sides (see BoundaryFresnel). What facets scatter twice or more can be added to the Schlick part as a broad lobe
///     m (1 - E1(wo)) (1 - E1(wi)) / (pi (1 - E1avg)) [Kulla & Conty 2017, "Revisiting Physically Based Shading at
///     Imageworks"], E1 the albedo of facets that reflect everything,
///     m = Favg^2 E1avg / (1 - Favg (1 - E1avg)). A thin film replaces its share of all Fresnel terms, seen from
///     outside; that share of the diffuse lobe is 1 - E(wo) alone, without the factor of wi, and is not reciprocal;
///   specular transmission: rough dielectric [Walter 2007] for solids, mirrored-reflection lobe for thin walls. What
///     facets of a boundary scatter twice or more is added on both sides in the same way, l the loss of each side:
///     t l_near(wo) l_far(wi) / (pi l_far avg) goes through and the rest comes back, t = (1 - Favg) min(1, l_far avg /
///     l_near avg), which keeps reciprocity. A solid of stretched facets has no table of losses and is left without.
/// Roughness below kDeltaRoughness is a perfect mirror or window: a delta lobe.
///
/// What is transported is radiance over the square of the refractive index, which refraction leaves as it is: no
/// factor eta^2 on the way in, none on the way out. In air that is radiance; a closed piece of glass in a furnace gives
/// 1 and albedos stay in [0,1] on both sides. Light emitted inside a solid is taken in the same measure.
/// A thin wall tints by baseColor, each face of a solid by its root: what is seen through either has the colour once.
class BaseBsdf {
public:
    static constexpr float kDeltaRoughness = kTabledRoughness;

    BaseBsdf() = default;
    BaseBsdf(const BsdfInputs& inputs, const Vec3& wo);

    const Vec3& wo() const { return wo_; }  ///< as used: unit, a little above the horizon
    BsdfValue evaluate(const Vec3& wi) const;
    /// `uLobe` chooses diffuse or specular by the luminance of their albedos (but each at least kMinLobeShare), and
    /// then reflection or transmission by what the facet drawn does.
    BsdfSample sample(float uLobe, Vec2 u) const;

    /// Directional albedo towards wo of one lobe, and of all specular lobes together. In [0,1].
    Vec3 albedo(Lobe lobe) const;
    Vec3 specularAlbedo() const { return albedo(Lobe::SpecularReflection) + albedo(Lobe::SpecularTransmission); }
    /// One lobe alone, f |cos|, for tests and for modules that replace a term. 0 for delta lobes.
    Vec3 evaluate(const Vec3& wi, Lobe lobe) const;
    /// True if every lobe is a delta: next-event estimation cannot contribute.
    bool isDelta() const;
    /// Is what it transmits all straight on?
    bool isWindow() const { return deltaTransmission_ && !solid_ && hasBoundary_; }
    /// Chance that sample() draws this lobe, lost samples included: exact for deltas and the diffuse lobe.
    float probability(Lobe lobe) const;

    /// Takes lobes away, as if they were black: what a path at a depth limit may no longer use. Albedos go with them.
    void keep(bool diffuse, bool specular);

    /// Makes the albedo tables that materials of this ior need (some 200 ms the first time), so that no path waits.
    /// `transmits`: also those of dielectric boundaries; `clear`: and of solid ones whose specular weight is below 1.
    /// Any thread.
    static void prepare(float ior, bool transmits, bool clear);

private:
    static constexpr float kMinLobeShare = 0.05f;
    enum Slot { kDiffuse, kReflection, kTransmission, kSlots };
    struct Facet {
        Vec3 reflected{0};           ///< Fresnel term of the reflection lobe
        float through = 0;           ///< share that a dielectric boundary lets through
        float reflectionChance = 1;  ///< of a specular sample at this facet
    };
    /// What an exact and a clear boundary reflect and let through, see BoundaryFresnel.
    struct BoundarySums {
        Vec2 exact{0}, clear{0};
        explicit BoundarySums(float = 0) {}
        BoundarySums(Vec2 e, Vec2 c) : exact(e), clear(c) {}
        BoundarySums& operator+=(const BoundarySums& o) { return exact += o.exact, clear += o.clear, *this; }
        friend BoundarySums operator*(float w, const BoundarySums& s) { return {w * s.exact, w * s.clear}; }
    };
    /// Tables of a rough solid, seen from one side.
    struct BoundaryTables {
        const DielectricAlbedo *exact = nullptr, *clear = nullptr;
    };

    void setFacets(const BsdfInputs& inputs, float roughness);
    void setFilm(const LayerInputs& layers, const Vec3& baseF0, float reflecting);
    void setMultiple(float share);
    void setBoundaryMultiple();
    void setDiffuse(const Vec3& rho, float f0, float f90);
    void setDiffuseUnderFilm(const Vec3& rho);
    void setBoundary(float ior, const Vec3& specularColor, bool inside);
    void setSpecular(bool inside, bool multiple);
    BoundarySums boundaryAlbedo(bool inside) const;
    BoundarySums stretchedBoundaryAlbedo() const;
    BoundarySums atBoundary(float cosTheta) const;
    Vec2 schlickTowards(bool dividedWell) const;
    void applyFilm();
    void chooseProbabilities();
    float reflectionChance(const Vec3& reflected, float through) const;
    Vec2 schlickAlbedo(const Vec3& w) const;
    Vec2 schlickAverage() const;
    static float multipleBelow(Vec2 schlick) { return std::max(0.0f, 1 - schlick.x - schlick.y); }
    Vec2 schlickWhereUsed(const Vec3& w) const;
    float boundaryReturned(const Vec3& w) const;
    float boundaryMean(const BoundaryTables& side) const;
    Facet facetAt(float cosTheta) const;

    LobeValue diffuse(const Vec3& wi, Vec2 schlick) const;
    LobeValue reflection(const Vec3& wi, const Vec3& h, Vec2 schlick) const;
    LobeValue transmissionThin(const Vec3& mirrored, const Vec3& h) const;
    LobeValue transmissionSolid(const Vec3& wi, const Vec3& h) const;
    LobeValue transmission(const Vec3& wi) const;
    LobeValue withMultiple(LobeValue once, const Vec3& wi) const;

    BsdfSample sampleDiffuse(Vec2 u) const;
    BsdfSample sampleSpecular(float choice, Vec2 u) const;
    BsdfSample upperSample(const Vec3& wi, const Vec3& h, Lobe lobe) const;
    BsdfSample transmissionSample(const Vec3& h) const;
    BsdfSample lowerSample(const Vec3& wi, const LobeValue& t) const;
    BsdfSample deltaTransmissionSample() const;
    BsdfSample deltaSample(Slot slot, const Vec3& wi) const;

    Vec3 wo_{0, 0, 1};
    Ggx ggx_;
    RoughnessRow row_;          ///< of all albedo tables
    float lambdaO_ = 0;         ///< ggx_.lambda(wo_)
    Vec2 schlickO_{1, 0};       ///< albedo towards wo under Schlick's term
    Vec2 schlickMean_{1, 0};    ///< and its mean over the hemisphere; where something uses it
    bool usesSchlick_ = false;  ///< the lobes depend on the albedo towards wi
    float eta_ = 1;             ///< index of the far side over that of wo's side
    bool smooth_ = false;       ///< reflection is a delta
    bool deltaTransmission_ = false;
    bool solid_ = false;
    bool hasBoundary_ = false;   ///< the base transmits: the exact Fresnel term takes part
    BoundaryFresnel fresnel_;    ///< as weighted
    float boundaryShare_ = 0;    ///< of the material
    BoundaryTables near_, far_;  ///< wo's side is near
    RoughnessRow boundaryRow_;   ///< of their tables
    float specular_ = 1;         ///< weight of the layer that reflects, of boundaries too

    Vec3 diffuseScale_{0};              ///< rho (1 - E(wo)) / (1 - Eavg) / pi where no film lies
    Vec3 diffuseUnderFilm_{0};          ///< rho (1 - E(wo)) / pi where one does
    float layerF0_ = 0, layerF90_ = 0;  ///< of the dielectric layer over the diffuse base
    float layerMultiple_ = 0;           ///< m of that layer
    Vec3 multiple_{0};                  ///< m of reflection, its share of the material multiplied in
    Vec3 multipleScale_{0};             ///< multiple_ (1 - E1(wo)) over pi (1 - E1avg)
    Vec3 boundaryScale_{0};  ///< the same of what a boundary reflects after many facets, and of what it transmits
    Vec3 throughScale_{0};
    Vec3 multipleAlbedo_{0};  ///< of both reflected parts, over what facets reflect once
    Vec3 throughAlbedo_{0};   ///< and of the transmitted part
    Vec3 f0_{0};              ///< Schlick part of reflection, its shares of the material multiplied in
    float f90_ = 0;
    Vec3 transmissionTint_{0};  ///< weight of what a boundary lets through

    bool hasFilm_ = false;
    ThinFilm film_;
    float filmShare_ = 0;       ///< of the surface
    float filmReflecting_ = 0;  ///< share of the material that reflects under the film
    float filmMultiple_ = 0;    ///< m of the layer under the film
    Vec3 filmAlbedo_{0};        ///< mean reflectance of the film over what facets reflect towards wo

    Vec3 albedo_[kSlots] = {Vec3(0), Vec3(0), Vec3(0)};
    float probability_[kSlots] = {0, 0, 0};
    float specularProbability_ = 0;  ///< of both specular lobes together
    float multipleShare_ = 0;        ///< of those, samples for what is scattered more than once
    float multipleThrough_ = 0;      ///< and of these, the transmitted ones
    float reflectedShare_ = 1;       ///< of reflection among the others, by albedo
};

}  // namespace lumi
