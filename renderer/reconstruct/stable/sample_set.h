#pragma once
#include <vector>

#include "reconstruct/stable/subpixel_mask.h"
#include "trace/ray.h"

namespace lumi {

/// A shading location as it is kept and reprojected, 16 bytes as in [DalCorso17, sec. 5]. It is a point of a triangle
/// (or of a light's body), so that it stays on skinned, morphed and subdivided surfaces, where the paper's object-space
/// position would not; or a direction, where the camera looks past everything.
struct SampleLocation {
    static constexpr uint32_t kSky = kNoInstance;      ///< then the other three are the bits of a unit direction
    static constexpr uint32_t kNew = kNoInstance - 1;  ///< still to be traced through its place on the screen

    uint32_t instance = kNew, primitive = 0;
    float u = 0, v = 0;  ///< barycentrics

    bool isNew() const { return instance == kNew; }
    bool isSky() const { return instance == kSky; }
    SurfacePoint point() const { return {instance, primitive, {u, v}, 0}; }
    Vec3 direction() const { return {std::bit_cast<float>(primitive), u, v}; }
    static SampleLocation ofPoint(const SurfacePoint& p) { return {p.instance, p.primitive, p.barycentrics.x, p.barycentrics.y}; }
    static SampleLocation ofSky(const Vec3& direction) { return {kSky, std::bit_cast<uint32_t>(direction.x), direction.y, direction.z}; }
};
static_assert(sizeof(SampleLocation) == 16);

/// What a sample has gathered, scene-linear. 36 bytes: the wide form of the paper's 8, which hold no HDR colour, no
/// indirect light and no count (sec. 6.1 adds those without saying where they are kept).
struct SampleLight {
    Vec3 direct{0};    ///< emission and light that met one surface: this frame's, or its mean since nothing moves
    Vec3 indirect{0};  ///< running average
    uint32_t name = 0;  ///< of its random numbers
    uint16_t directCount = 0, indirectCount = 0;  ///< paths in the two; they stay at 65535
    uint16_t age = 0;                             ///< frames since it was traced, at most 65535
    uint16_t pathsDrawn = 0;                      ///< of its sequence of random numbers, modulo 65536
    Vec3 radiance() const { return direct + indirect; }
};
static_assert(sizeof(SampleLight) == 36);

/// The sample buffer of one frame [DalCorso17, sec. 4]: up to 16 samples a pixel. Where the paper has 16 slots for each
/// pixel, here the samples lie without gaps, pixel after pixel in rows, those of a pixel in the order of their
/// sub-pixels: memory is that of the samples which exist, and work over them is balanced by itself.
///
/// Bytes a pixel: 4 (word) + 4 (first) and 60 for each sample: 16 (location), 8 (place), 36 (light). At 1.25 samples a
/// pixel that is 83, and three such sets are held (StableModule::byteCount() has the sum); the paper's buffers have 648 whatever
/// the number, a set with all 16 would have 968.
struct SampleSet {
    Extent2 extent;
    std::vector<uint32_t> words;  ///< a pixel
    std::vector<uint32_t> first;  ///< index of each pixel's first sample, and one more: the number of samples
    std::vector<SampleLocation> locations;
    std::vector<Vec2> places;     ///< on the screen, continuous pixels
    std::vector<SampleLight> lights;

    size_t size() const { return locations.size(); }
    size_t bytes() const {
        return (words.size() + first.size()) * 4 + size() * (sizeof(SampleLocation) + sizeof(Vec2) + sizeof(SampleLight));
    }
};

}  // namespace lumi
