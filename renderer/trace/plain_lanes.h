#pragma once
#include <cstdint>

namespace lumi {

/// Path vertices on plain surfaces: no layers, nothing transmitted. They are most vertices of most scenes, so they are
/// shaded many at a time, a lane each, by kernels (plain_kernels.h) that do what Bsdf and the integrator do one by one.
/// Members are columns over the lanes. World space, unless said otherwise.
struct alignas(64) PlainLanes {
    static constexpr int kMost = 256;
    /// A cache line longer than it need be: at a power of two, all columns of a lane would share a few sets of the
    /// cache.
    static constexpr int kStride = kMost + 16;
    using Column = float[kStride];
    using Words = uint32_t[kStride];
    struct Column3 {
        Column x, y, z;
        template <class V>
        void set(int i, const V& v) {
            x[i] = v.x, y[i] = v.y, z[i] = v.z;
        }
        template <class V>
        V get(int i) const {
            return V(x[i], y[i], z[i]);
        }
    };

    int count = 0;
    bool glossy = false;    ///< some lane is metallic or has a specular layer; else all are diffuse
    bool textured = false;  ///< some lane has textures: the columns of texture coordinates are set
    bool mapped = false;    ///< some lane has a normal map
    Words row;              ///< of the batch
    Words scramble, index;  ///< of the path's random numbers
    uint64_t seeds[kMost];  ///< scratch

    // The triangle that was hit, as `place` and `bend` read it.
    Column3 corner, edge1, edge2;
    Column3 vertexNormal;  ///< interpolated, any length; 0: flat
    Column flip;           ///< 1; -1 for mirrored instances, whose front faces are turned
    Column across, along;  ///< barycentrics of the second and third corner
    Column width;          ///< of the path's footprint on arrival, metres
    Column cornerU, cornerV, edge1U, edge1V, edge2U, edge2V;     ///< texture coordinates
    Column textureU, textureV, textureWidth;                     ///< at the point, and the footprint's width there
    Column area;                                                 ///< of the triangle, m^2
    Column front;                                                ///< 1: wo is on the front side; else 0
    Column3 smoothNormal;                                        ///< unit, of the front face
    Column tangents;                                             ///< for the normal map: kNone, kGiven, kDerived
    static constexpr float kNone = 0, kGiven = 1, kDerived = 2;  ///< the last: along growing u and falling v
    Column3 tangent, bitangent;                                  ///< any length, if they are given
    Column3 mapTexel;                                            ///< of the normal map, scale applied

    // Where the path is: as in Surface and BsdfInputs.
    Column3 position, geometricNormal, normal, wo, throughput;
    Column offset;
    Column3 baseColor, specularColor;
    Column metallic, roughness, ior, specular;
    Words lobes;  ///< kDiffuseLobe | kSpecularLobe: which the path may still use
    static constexpr uint32_t kDiffuseLobe = 1, kSpecularLobe = 2;

    // Random numbers.
    Column lobeX, bsdfX, bsdfY, lightX, lightY, lightPointX, lightPointY, rouletteX;

    // The scattering function, made by `prepare`; names as in BaseBsdf.
    Column3 axisX, axisY;           ///< of the local frame
    Column3 woLocal, start;         ///< `start` is where rays leave the surface
    Column alpha, lambdaO, smooth;  ///< smooth: 1 or 0
    Column tableRow;                ///< fractional row of the table of albedos
    Column3 f0, diffuseScale, multipleScale;
    Column f90, layerF0, layerF90, layerMultiple;
    Column diffuseProbability, specularProbability, multipleShare;
    Column3 diffuseAlbedo, specularAlbedo, reflectedAlbedo;  ///< the last without what many facets scatter

    // A light sample for each lane; pdf 0: none.
    Column3 lightDirection, lightTarget, lightRadiance;
    Column lightDistance, lightPdf, lightWeighs;  ///< weighs: 1 if continued paths find it too
    // And what becomes of it.
    Column3 lightDiffuse, lightSpecular, lightContribution, shadowDirection;
    Column shadowLength, lightValid;  ///< valid: 1; 0: nothing to trace; -1: not finite

    // The continuation.
    Column3 nextDirection, weight, diffuseShare;
    Column pdf;  ///< 0 for mirrors
    Words next;  ///< kEnds or the lobe drawn
    static constexpr uint32_t kEnds = 0, kDiffuse = 1, kReflects = 2, kMirrors = 3;
};

}  // namespace lumi
