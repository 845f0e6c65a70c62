// Plain surfaces, many lanes at a time; formulas and their sources are BaseBsdf's.
#include "trace/plain_kernels.h"

#include "trace/plain_lane_steps.h"

namespace lumi::LUMI_ISA {
namespace {

constexpr float kLeastLobeShare = 0.05f, kLeastLoss = 1e-7f;

using Lanes = PlainLanes;

LUMI_LANE float schlickWeightAt(float cosTheta) {
    const float m = cosTheta < 1 ? 1 - cosTheta : 0.0f;
    return m * m * (m * m) * m;
}

/// Albedo of facets under Schlick's term: F0 * first + F90 * second.
struct Pair {
    float first, second;
};

LUMI_LANE Pair lerpPair(const float* low, const float* high, int index, float f) {
    const float x = low[index] + (high[index] - low[index]) * f;
    const float y = low[index + 1] + (high[index + 1] - low[index + 1]) * f;
    return {x, y};
}

/// SchlickAlbedo::directional(), or the closed form of mirrors.
/// `smooth` is 1 or 0: by a product, since a table is not read in only some lanes.
LUMI_LANE Pair albedoTowards(const AlbedoView& view, float alpha, float tableRow, float smooth, float cosTheta) {
    const float c = within(cosTheta, 0.0f, 1.0f), side2 = alpha * alpha * (1 - c * c);
    const float length = std::sqrt(c * c + side2);
    const float column = 1 / (1 + std::sqrt(side2 / most((length + c) * c, 1e-30f)));
    // A light sample without a direction is dropped later: here it must be a place of the table all the same.
    const float x = most(0.0f, column * static_cast<float>(view.columns - 1));
    int first = static_cast<int>(x);
    first = first < 0 ? 0 : first > view.columns - 2 ? view.columns - 2 : first;
    int row = static_cast<int>(tableRow);
    row = row > view.rows - 2 ? view.rows - 2 : row;
    const float fx = x - static_cast<float>(first), fy = tableRow - static_cast<float>(row);
    const int index = 2 * (row * view.columns + first);
    const float* low = view.smooth;
    const float* high = view.smooth + 2 * view.columns;
    const float lowX = low[index] + (low[index + 2] - low[index]) * fx;
    const float lowY = low[index + 1] + (low[index + 3] - low[index + 1]) * fx;
    const float highX = high[index] + (high[index + 2] - high[index]) * fx;
    const float highY = high[index + 1] + (high[index + 3] - high[index + 1]) * fx;
    const float sum = lowX + (highX - lowX) * fy, rest = lowY + (highY - lowY) * fy;
    const float grazing = within(sum * schlickWeightAt(length) + length * rest, 0.0f, sum);
    const float mirror = schlickWeightAt(cosTheta), rough = 1 - smooth;
    return {smooth * (1 - mirror) + rough * (sum - grazing), smooth * mirror + rough * grazing};
}

LUMI_LANE Pair albedoMean(const AlbedoView& view, float alpha, float tableRow, float smooth) {
    const float position = tableRow * static_cast<float>(view.averageSteps);
    int row = static_cast<int>(position);
    row = row > view.averageRows - 2 ? view.averageRows - 2 : row;
    const Pair mean = lerpPair(view.average, view.average + 2, 2 * row, position - static_cast<float>(row));
    const float many = 1 - mean.first * (alpha * alpha) - mean.second;
    return {smooth * (20.0f / 21) + (1 - smooth) * many, smooth * (1.0f / 21) + (1 - smooth) * mean.second};
}

LUMI_LANE float manyBounces(float favg, float eavg) { return favg * favg * eavg / (1 - favg * (1 - eavg)); }
LUMI_LANE float meanSchlick(float f0, float f90) { return f0 + (f90 - f0) * (1.0f / 21); }
LUMI_LANE float lambdaOf(float alpha, float z) {
    const float z2 = most(z * z, 1e-12f);
    return 0.5f * (std::sqrt(1 + alpha * alpha * (1 - z2) / z2) - 1);
}

/// `v` as a unit vector, or `other` if it has no direction.
LUMI_LANE Lane3 unitOr(Lane3 v, Lane3 other) {
    const float length2 = dot(v, v);
    const bool some = (length2 > 0) & finite(length2);
    return choose(some, v * (1 / std::sqrt(some ? length2 : 1.0f)), other);
}

void placeSurfaces(Lanes& lanes) {
    const int count = lanes.count;
#pragma GCC ivdep
    for (int i = 0; i < count; ++i) {
        const Lane3 edge1 = at(lanes.edge1, i), edge2 = at(lanes.edge2, i), wo = at(lanes.wo, i);
        const float b1 = lanes.across[i], b2 = lanes.along[i];
        put(lanes.position, i, at(lanes.corner, i) + edge1 * b1 + edge2 * b2);
        const Lane3 product = cross(edge1, edge2) * lanes.flip[i];
        const float twiceArea = std::sqrt(dot(product, product));
        const Lane3 outward = unitOr(product, wo);
        const float cosine = dot(outward, wo);
        put(lanes.geometricNormal, i, choose(cosine >= 0, outward, outward * -1.0f));
        lanes.area[i] = 0.5f * twiceArea;
        lanes.front[i] = cosine >= 0 ? 1.0f : 0.0f;
        put(lanes.smoothNormal, i, unitOr(at(lanes.vertexNormal, i), outward));
    }
}

/// Texture coordinates, and the footprint in them.
void placeTextures(Lanes& lanes) {
    const int count = lanes.count;
#pragma GCC ivdep
    for (int i = 0; i < count; ++i) {
        const float b1 = lanes.across[i], b2 = lanes.along[i], twiceArea = 2 * lanes.area[i];
        const float cosine = dot(at(lanes.geometricNormal, i), at(lanes.wo, i));
        const float footprint = lanes.width[i] / std::sqrt(most(std::fabs(cosine), 0.04f));  // on the surface, metres
        const float u1 = lanes.edge1U[i], v1 = lanes.edge1V[i], u2 = lanes.edge2U[i], v2 = lanes.edge2V[i];
        lanes.textureU[i] = lanes.cornerU[i] + u1 * b1 + u2 * b2;
        lanes.textureV[i] = lanes.cornerV[i] + v1 * b1 + v2 * b2;
        const float density = std::fabs(u1 * v2 - v1 * u2) / (twiceArea > 0 ? twiceArea : 1.0f);
        lanes.textureWidth[i] = twiceArea > 0 ? footprint * std::sqrt(density) : 0.0f;
    }
}

void place(Lanes& lanes) {
    placeSurfaces(lanes);
    if (lanes.textured) placeTextures(lanes);
}

/// Direction across `normal` in which u grows and v stays, any length; 0 where there is none. `c1` and `c2` are the
/// differences of v along the triangle's edges. With those of u instead, v falls and u stays, as along glTF's
/// bitangent.
LUMI_LANE Lane3 uvGradient(const Lanes& lanes, int i, Lane3 normal, float c2, float c1) {
    const float determinant = lanes.edge1U[i] * lanes.edge2V[i] - lanes.edge1V[i] * lanes.edge2U[i];
    const float sign = determinant > 0 ? 1.0f : determinant < 0 ? -1.0f : 0.0f;
    const Lane3 along = (at(lanes.edge1, i) * c2 - at(lanes.edge2, i) * c1) * sign;
    return along - normal * dot(normal, along);
}

/// The shading normal by the normal map, where there is one; unit, of the front face.
LUMI_LANE Lane3 mappedNormal(const Lanes& lanes, int i, Lane3 smooth) {
    const bool derived = lanes.tangents[i] == Lanes::kDerived;
    const Lane3 tangent =
        choose(derived, uvGradient(lanes, i, smooth, lanes.edge2V[i], lanes.edge1V[i]), at(lanes.tangent, i));
    const Lane3 bitangent =
        choose(derived, uvGradient(lanes, i, smooth, lanes.edge2U[i], lanes.edge1U[i]), at(lanes.bitangent, i));
    const float lengthT = std::sqrt(dot(tangent, tangent)), lengthB = std::sqrt(dot(bitangent, bitangent));
    const bool mapped = (lanes.tangents[i] != Lanes::kNone) & (lengthT > 0) & (lengthB > 0) & finite(lengthT + lengthB);
    const Lane3 texel = at(lanes.mapTexel, i);
    const Lane3 sum = tangent * (texel.x / (mapped ? lengthT : 1.0f)) +
                      bitangent * (texel.y / (mapped ? lengthB : 1.0f)) + smooth * texel.z;
    const float length = std::sqrt(dot(sum, sum));
    const bool usable = mapped & (length > 1e-6f) & finite(length);
    return choose(usable, sum * (1 / (usable ? length : 1.0f)), smooth);
}

/// The normal that shades: `normal` on wo's side, and bent so that the mirror direction stays above the surface [Keller
/// et al. 2017].
LUMI_LANE Lane3 keptAbove(const Lanes& lanes, int i, Lane3 normal) {
    // Height above the surface, in half precision, that the reflection off a bent normal keeps.
    constexpr float kLeastHeight = 1e-3f;
    // One that points away from the geometric normal altogether is a modelling slip.
    const Lane3 geometric = at(lanes.geometricNormal, i), wo = at(lanes.wo, i);
    const float sign = lanes.front[i] > 0 ? 1.0f : -1.0f;
    const Lane3 shading = normal * (sign * dot(normal, geometric) < 0 ? -sign : sign);
    const float cosine = dot(wo, shading);
    const Lane3 mirrored = shading * (2 * cosine) - wo;
    const float height = dot(mirrored, geometric);
    const Lane3 lifted = mirrored + geometric * (kLeastHeight - height);
    const Lane3 bent = unitOr(wo + unitOr(lifted, geometric), geometric);
    return choose((height >= kLeastHeight) & (cosine > 0), shading, bent);
}

void bend(Lanes& lanes) {
    const int count = lanes.count;
    if (!lanes.mapped) {
#pragma GCC ivdep
        for (int i = 0; i < count; ++i) put(lanes.normal, i, keptAbove(lanes, i, at(lanes.smoothNormal, i)));
        return;
    }
#pragma GCC ivdep
    for (int i = 0; i < count; ++i)
        put(lanes.normal, i, keptAbove(lanes, i, mappedNormal(lanes, i, at(lanes.smoothNormal, i))));
}

void prepare(Lanes& lanes, const AlbedoView& view, const PlainSettings& settings) {
    const float many = settings.multipleScattering ? 1.0f : 0.0f;
    const int count = lanes.count;
#pragma GCC ivdep
    for (int i = 0; i < count; ++i) {
        // The local frame.
        const Lane3 normal = at(lanes.normal, i);
        const LaneFrame frame = frameAround(normal);
        Lane3 wo = toLocal(frame, at(lanes.wo, i));
        wo.z = most(wo.z, kLeastCosine);
        wo = unit(wo);
        put(lanes.axisX, i, frame.x), put(lanes.axisY, i, frame.y);
        put(lanes.woLocal, i, wo);
        putStart(lanes, i);

        // Facets.
        const float roughness = saturated(lanes.roughness[i]), bound = view.leastRoughness;
        const float smooth = roughness < bound ? 1.0f : 0.0f;
        const float kept = most(roughness, bound), alpha = kept * kept;
        const float above = (kept - bound) / (1 - bound);
        const float tableRow = within((std::sqrt(0.25f + 2 * above) - 0.5f) * static_cast<float>(view.rows - 1), 0.0f,
                                      static_cast<float>(view.rows - 1));
        const Pair towards = albedoTowards(view, alpha, tableRow, smooth, wo.z);
        const Pair mean = albedoMean(view, alpha, tableRow, smooth);
        lanes.alpha[i] = alpha, lanes.tableRow[i] = tableRow;
        lanes.smooth[i] = smooth;
        lanes.lambdaO[i] = lambdaOf(alpha, wo.z);

        // Reflection, once and many times.
        const float metallic = saturated(lanes.metallic[i]), opaque = 1 - metallic, specular = lanes.specular[i];
        const Lane3 colour = at(lanes.baseColor, i), tint = at(lanes.specularColor, i);
        const Lane3 base = {saturated(colour.x), saturated(colour.y), saturated(colour.z)};
        const float ior = lanes.ior[i], normalF0 = square((ior - 1) / (ior + 1));
        const Lane3 layer = {least(normalF0 * tint.x, 1.0f) * specular, least(normalF0 * tint.y, 1.0f) * specular,
                             least(normalF0 * tint.z, 1.0f) * specular};
        const Lane3 f0 = layer * opaque + base * metallic;
        const float f90 = opaque * specular + metallic;
        const float eavg = mean.first + mean.second, lost = most(0.0f, 1 - towards.first - towards.second);
        const float spreads = many * (1 - smooth);
        const float layerF0 = mostOf(layer);
        const float layerMany = spreads * manyBounces(meanSchlick(layerF0, specular), eavg);
        const Lane3 multiple = {spreads * manyBounces(least(meanSchlick(f0.x, f90), 1.0f), eavg),
                                spreads * manyBounces(least(meanSchlick(f0.y, f90), 1.0f), eavg),
                                spreads * manyBounces(least(meanSchlick(f0.z, f90), 1.0f), eavg)};
        const bool maySpecular = (lanes.lobes[i] & Lanes::kSpecularLobe) != 0;
        const bool mayDiffuse = (lanes.lobes[i] & Lanes::kDiffuseLobe) != 0;
        const float specularKept = maySpecular ? 1.0f : 0.0f;
        // The surface's albedo is the same whatever lobes the path may still take.
        const Lane3 onceAlbedo = {f0.x * towards.first + f90 * towards.second,
                                  f0.y * towards.first + f90 * towards.second,
                                  f0.z * towards.first + f90 * towards.second};
        put(lanes.specularAlbedo, i, onceAlbedo + multiple * lost);
        const Lane3 reflected = onceAlbedo * specularKept, multipleAlbedo = multiple * (lost * specularKept);
        put(lanes.f0, i, f0);
        lanes.f90[i] = f90;
        put(lanes.multipleScale, i, multipleAlbedo * (kLaneInvPi / most(1 - eavg, kLeastLoss)));
        put(lanes.reflectedAlbedo, i, reflected);

        // The diffuse base under it.
        const float below0 = layerF0 - layerMany, below90 = specular - layerMany;
        const float through = most(0.0f, 1 - (towards.first * below0 + towards.second * below90 + layerMany));
        const float meanThrough = 1 - (mean.first * below0 + mean.second * below90 + layerMany);
        const Lane3 diffuseAlbedo = base * (opaque * through);
        const Lane3 diffuse = diffuseAlbedo * (mayDiffuse ? 1.0f : 0.0f);
        lanes.layerF0[i] = below0, lanes.layerF90[i] = below90, lanes.layerMultiple[i] = layerMany;
        put(lanes.diffuseAlbedo, i, diffuseAlbedo);
        put(lanes.diffuseScale, i, diffuse * (kLaneInvPi / most(meanThrough, 1e-4f)));

        // Chances of the lobes.
        const float d = brightness(diffuse), once = brightness(reflected), more = brightness(multipleAlbedo);
        const float s = once + more, floor = kLeastLobeShare * (d + s);
        const float dKept = d > 0 ? most(d, floor) : 0.0f, sKept = s > 0 ? most(s, floor) : 0.0f;
        const float sum = dKept + sKept, usable = sum > 0 ? sum : 1.0f;
        lanes.diffuseProbability[i] = dKept / usable;
        lanes.specularProbability[i] = sKept / usable;
        lanes.multipleShare[i] = s > 0 ? more / s : 0.0f;
    }
}

/// f |cos| and densities of one direction above the surface; 0 below.
struct Scattered {
    Lane3 diffuse, specular;
    float pdf;
};

LUMI_LANE Scattered scatteredTo(const Lanes& lanes, int i, const AlbedoView& view, Lane3 wo, Lane3 wi, Lane3 h) {
    const float alpha = lanes.alpha[i];
    const bool smooth = lanes.smooth[i] > 0, above = wi.z > 0;
    const Pair albedo = albedoTowards(view, alpha, lanes.tableRow[i], lanes.smooth[i], wi.z);
    const float cosPdf = wi.z * kLaneInvPi;

    const float pd = lanes.diffuseProbability[i];
    const float through =
        most(0.0f, 1 - (albedo.first * lanes.layerF0[i] + albedo.second * lanes.layerF90[i] + lanes.layerMultiple[i]));
    const float diffuseKept = above && pd > 0 ? through * wi.z : 0.0f;

    // Facets.
    const float cosFacet = dot(wo, h), f90 = lanes.f90[i];
    const float weight = schlickWeightAt(cosFacet), a2 = alpha * alpha;
    const float slope = h.x * h.x + h.y * h.y + a2 * h.z * h.z;
    const float density = a2 * kLaneInvPi / (slope * slope) / (4 * wo.z);
    const float lambdaO = lanes.lambdaO[i];
    const float ps = lanes.specularProbability[i], share = lanes.multipleShare[i];
    const bool reflects = above && !smooth && ps > 0, facets = reflects && cosFacet > 0;
    const float once = facets ? density / (1 + lambdaO + lambdaOf(alpha, wi.z)) : 0.0f;
    const float oncePdf = facets ? density / (1 + lambdaO) : 0.0f;
    const float lost = reflects ? most(0.0f, 1 - albedo.first - albedo.second) * wi.z : 0.0f;
    const Lane3 f0 = at(lanes.f0, i), multiple = at(lanes.multipleScale, i);
    const float specularPdf = reflects ? (1 - share) * oncePdf + share * cosPdf : 0.0f;

    Scattered s;
    s.diffuse = at(lanes.diffuseScale, i) * diffuseKept;
    s.specular = {(f0.x + (f90 - f0.x) * weight) * once + multiple.x * lost,
                  (f0.y + (f90 - f0.y) * weight) * once + multiple.y * lost,
                  (f0.z + (f90 - f0.z) * weight) * once + multiple.z * lost};
    s.pdf = (above ? pd * cosPdf : 0.0f) + ps * specularPdf;
    return s;
}

LUMI_LANE Lane3 halfOf(Lane3 sum) {
    const float length2 = dot(sum, sum);
    const bool some = length2 > 1e-14f;
    const float scale = some ? std::copysign(1.0f, sum.z) / std::sqrt(some ? length2 : 1.0f) : 0.0f;
    return sum * scale;
}

LUMI_LANE LaneFrame frameOf(const Lanes& lanes, int i) {
    return {at(lanes.axisX, i), at(lanes.axisY, i), at(lanes.normal, i)};
}

void light(Lanes& lanes, const AlbedoView& view, const PlainSettings& settings) {
    const bool mis = settings.mis;
    const int count = lanes.count;
#pragma GCC ivdep
    for (int i = 0; i < count; ++i) {
        const Lane3 wo = at(lanes.woLocal, i), wi = toLocal(frameOf(lanes, i), at(lanes.lightDirection, i));
        const Scattered f = scatteredTo(lanes, i, view, wo, wi, halfOf(wo + wi));
        putLight(lanes, i, f.diffuse, f.specular, f.pdf, wi.z > 0, mis);
    }
}

/// A facet normal seen from `wo`, as Ggx::sampleVisibleNormal() [Dupuy & Benyoub 2023].
LUMI_LANE Lane3 visibleNormalAt(Lane3 wo, float alpha, float u, float v) {
    const SinCos phi = sinCosTurns(v);
    const Lane3 stretched = unit({alpha * wo.x, alpha * wo.y, wo.z});
    const float z = (1 - u) * (1 + stretched.z) - stretched.z;
    const float r = std::sqrt(most(0.0f, 1 - z * z));
    const Lane3 h = stretched + Lane3{r * phi.cosine, r * phi.sine, z};
    return unit({alpha * h.x, alpha * h.y, most(h.z, 1e-7f)});
}

void scatter(Lanes& lanes, const AlbedoView& view, const PlainSettings& settings) {
    const bool roulette = settings.roulette;
    const int count = lanes.count;
#pragma GCC ivdep
    for (int i = 0; i < count; ++i) {
        const Lane3 wo = at(lanes.woLocal, i);
        const float pd = lanes.diffuseProbability[i], ps = lanes.specularProbability[i], u = lanes.lobeX[i];
        const float share = lanes.multipleShare[i];
        const bool diffuse = (ps == 0) | (u < pd), smooth = lanes.smooth[i] > 0;
        const float choice = least((u - pd) / (ps > 0 ? ps : 1.0f), kBelowOne);
        const bool mirror = !diffuse & smooth, cosineLobe = diffuse | (choice < share);

        // A direction and the facet between it and wo.
        const float u1 = lanes.bsdfX[i], u2 = lanes.bsdfY[i];
        const Lane3 hemisphere = cosineHemisphere(u1, u2);
        const Lane3 facet = visibleNormalAt(wo, lanes.alpha[i], u1, u2);
        const Lane3 reflected = unit(facet * (2 * dot(wo, facet)) - wo);
        Lane3 wi = choose(cosineLobe, hemisphere, reflected);
        const Lane3 h = choose(cosineLobe, halfOf(wo + hemisphere), facet);
        wi = choose(mirror, Lane3{-wo.x, -wo.y, wo.z}, wi);

        const Scattered f = scatteredTo(lanes, i, view, wo, wi, h);
        const bool some = f.pdf > 0;
        const Lane3 both = (f.diffuse + f.specular) * (1 / (some ? f.pdf : 1.0f));
        const Lane3 weight = choose(mirror, at(lanes.reflectedAlbedo, i) * (1 / (ps > 0 ? ps : 1.0f)), both);
        const bool goes = putContinuation(lanes, i, frameOf(lanes, i), wi, weight, mirror | some, roulette);
        lanes.pdf[i] = mirror ? 0.0f : f.pdf;
        const float whole = diffuse ? 1.0f : 0.0f;
        const auto shareOf = [&](float d, float s) { return d + s > 0 && !mirror ? d / (d + s) : whole; };
        put(lanes.diffuseShare, i,
            {shareOf(f.diffuse.x, f.specular.x), shareOf(f.diffuse.y, f.specular.y),
             shareOf(f.diffuse.z, f.specular.z)});
        const uint32_t lobe = mirror ? Lanes::kMirrors : diffuse ? Lanes::kDiffuse : Lanes::kReflects;
        lanes.next[i] = goes ? lobe : Lanes::kEnds;
    }
}

}  // namespace

const PlainKernels& plainTable() {
    static const PlainKernels table{place, bend};
    return table;
}

const PlainLobeKernels& plainLobeTable() {
    static const PlainLobeKernels table{prepare, light, scatter};
    return table;
}

}  // namespace lumi::LUMI_ISA
