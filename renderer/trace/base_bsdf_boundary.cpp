#include <algorithm>
#include <cmath>

#include "trace/base_bsdf.h"
#include "trace/fresnel.h"
#include "trace/visible_normals.h"

namespace lumi {
namespace {

using WideLattice = FibonacciLattice<144, 89>;
using WidestLattice = FibonacciLattice<987, 610>;

/// Mean losses are at least this, to divide by.
constexpr float kLeastLoss = 1e-7f;

}  // namespace

/// What one facet does with light at this cosine.
BaseBsdf::BoundarySums BaseBsdf::atBoundary(float cosTheta) const {
    const float f = fresnelDielectric(std::min(cosTheta, 1.0f), eta_);
    // Behind a thin wall is what is before it: it bends all.
    const float total = solid_ && eta_ < 1 && f == 1 ? 1.0f : 0.0f;
    return {Vec2(f, 1 - f), Vec2(total, 1 - total)};
}

/// Of light that meets one facet.
BaseBsdf::BoundarySums BaseBsdf::boundaryAlbedo(bool inside) const {
    if (smooth_) return atBoundary(wo_.z);
    const float all = schlickO_.x + schlickO_.y;
    BoundarySums once;
    if (ggx_.isAnisotropic()) {
        once = stretchedBoundaryAlbedo();
    } else {
        const float ior = inside ? 1 / eta_ : eta_;
        const auto tabled = [&](const DielectricAlbedo* own, bool clear) {
            // The table of losses is the better one.
            const float most = own ? 1 - own->lost(boundaryRow_, {ggx_.alpha, wo_.z}) : all;
            const DielectricAlbedo& table = own ? *own : DielectricAlbedo::get(ior, !inside, clear);
            const float reflected = std::min(table.reflected(boundaryRow_, wo_.z), most);
            return Vec2(reflected, most - reflected);
        };
        once.exact = tabled(near_.exact, false);
        if (solid_ && fresnel_.usesClear()) once.clear = tabled(near_.clear, true);
    }
    if (deltaTransmission_) return {Vec2(once.exact.x, 1 - once.exact.x), Vec2(once.clear.x, 1 - once.clear.x)};
    // A thin wall passes on in the mirrored direction what its outer face does not reflect.
    if (!solid_) return {Vec2(once.exact.x, std::max(0.0f, all - once.exact.x)), Vec2(0, all)};
    return once;
}

/// The same of stretched facets, by quadrature; total reflection makes a kink, which wants a finer one.
BaseBsdf::BoundarySums BaseBsdf::stretchedBoundaryAlbedo() const {
    const auto atFacet = [&](const Vec3& h) {
        BoundarySums at = atBoundary(glm::dot(wo_, h));
        const float reflected = reflectedShare(ggx_, wo_, lambdaO_, h);
        Vec3 wi;
        const bool bends = solid_ && refract(wo_, h, eta_, wi) && wi.z < 0;
        const Vec2 kept(reflected, bends ? (1 + lambdaO_) * maskingBothSides(lambdaO_, ggx_.lambda(wi)) : 0);
        at.exact *= kept, at.clear *= kept;
        return at;
    };
    return eta_ < 1 ? meanOverVisibleNormals<WidestLattice>(ggx_, wo_, atFacet)
                    : meanOverVisibleNormals<WideLattice>(ggx_, wo_, atFacet);
}

/// What a rough boundary gives back of what it loses to second facets, for light from `w` on either side.
float BaseBsdf::boundaryReturned(const Vec3& w) const {
    const auto lostByAll = [&] { return multipleBelow(schlickAlbedo({w.x, w.y, std::abs(w.z)})); };
    const BoundaryTables& side = w.z > 0 ? near_ : far_;
    if (!side.exact) return lostByAll();
    const FacetView view(ggx_.alpha, std::abs(w.z));
    return fresnel_.most(fresnel_.usesAll() ? lostByAll() : 0, side.exact->returned(boundaryRow_, view),
                         side.clear ? side.clear->returned(boundaryRow_, view) : 0);
}

/// Mean of that over the hemisphere on one side, weighted by the cosine.
float BaseBsdf::boundaryMean(const BoundaryTables& side) const {
    const float all = std::max(1 - schlickMean_.x - schlickMean_.y, kLeastLoss);
    if (!side.exact) return all;
    const float exact = side.exact->averageReturned(boundaryRow_, ggx_.alpha);
    const float clear = side.clear ? side.clear->averageReturned(boundaryRow_, ggx_.alpha) : 0;
    // Where a colour takes from F0, the difference of two tables must not come near 0.
    return std::max(fresnel_.most(all, exact, clear), 0.5f * fresnel_.most(0, exact, clear));
}

/// Gives a rough boundary what single scattering loses: to each side in proportion to what its mean Fresnel term
/// leaves, held where reciprocity wants it. With l the losses of both sides and t the shares that go through,
/// t_near l_near = n^2 t_far l_far; (1 - Favg) obeys that with n^2 alone, the lesser loss of both adds the rest.
void BaseBsdf::setBoundaryMultiple() {
    const float lost = boundaryReturned(wo_), mean = boundaryMean(near_), meanFar = boundaryMean(far_);
    const DielectricAlbedo& exact = near_.exact ? *near_.exact : DielectricAlbedo::get(eta_, true);
    const float total = near_.clear ? near_.clear->averageFresnel() : 0;
    const float fresnel = std::min(fresnel_.most(1, exact.averageFresnel(), total), 1.0f);
    const float through = (1 - fresnel) * std::min(1.0f, meanFar / mean);
    // What comes back has the colour that facets reflect in the mean.
    const Vec3 tint = fresnel > 0 ? fresnel_.reflected(1, exact.averageFresnel(), total) / fresnel : Vec3(1);
    Vec3 reflected = tint * (1 - through), passed(through);
    if (hasFilm_) {
        const Vec3 film = specular_ * film_.averageReflectance();
        reflected += (film - reflected) * filmShare_;
        passed *= 1 - filmShare_ + filmShare_ * (1 - maxComponent(film)) / std::max(1 - fresnel, 1e-6f);
    }
    const Vec3 above = boundaryShare_ * reflected * lost;
    throughAlbedo_ = transmissionTint_ * passed * lost;
    multipleAlbedo_ += above;
    boundaryScale_ = above * (kInvPi / mean);
    throughScale_ = throughAlbedo_ * (kInvPi / meanFar);
}

}  // namespace lumi
