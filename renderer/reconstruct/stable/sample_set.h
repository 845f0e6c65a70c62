#pragma once
#include <memory>
#include <vector>

#include "base/vectors.h"
#include "reconstruct/stable/subpixel_mask.h"
#include "trace/ray.h"

namespace lumi {

struct Scene;

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
    static SampleLocation ofPoint(const SurfacePoint& p) {
        return {p.instance, p.primitive, p.barycentrics.x, p.barycentrics.y};
    }
    static SampleLocation ofSky(const Vec3& direction) {
        return {kSky, std::bit_cast<uint32_t>(direction.x), direction.y, direction.z};
    }
};
static_assert(sizeof(SampleLocation) == 16);

/// What is known of a sample beside its place and its light.
struct SampleNote {
    uint32_t name = 0;                            ///< of its random numbers
    uint16_t directCount = 0, indirectCount = 0;  ///< paths in its light; they stay at 65535
    uint16_t age = 0;                             ///< frames since it was traced, at most 65535
    uint16_t pathsDrawn = 0;                      ///< of its sequence of random numbers, modulo 65536
};
static_assert(sizeof(SampleNote) == 12);

/// The sample buffer of one frame [DalCorso17, sec. 4]: up to 16 samples a pixel. Where the paper has 16 slots for each
/// pixel, here the samples lie without gaps, pixel after pixel in rows, those of a pixel in the order of their
/// sub-pixels: memory is that of the samples which exist, and work over them is balanced by itself. Each thing that is
/// known of a sample is a vector of its own, so that a step reads nothing else.
///
/// Bytes a pixel: 4 (word) + 4 (first) and 73 for each sample: 16 (location), 12 (in the world), 8 (place), 1 (flags),
/// 12 (note), 12 (direct light), 12 (indirect light; only where paths are longer than one surface). At 1.25 samples a
/// pixel that is 99, and three such sets are held (StableModule::byteCount() has the sum); the paper's buffers have 648
/// whatever the number, a set with all 16 would have 1176. Light is the wide form of the paper's 8 bytes, which hold no
/// HDR colour, no indirect light and no count (sec. 6.1 adds those without saying where they are kept).
struct SampleSet {
    static constexpr uint8_t kOccluded = 1, kSky = 2, kOnLight = 4;  ///< flags; the last: on the body of a light

    Extent2 extent;
    std::vector<uint32_t> words;  ///< a pixel
    std::vector<uint32_t> first;  ///< index of each pixel's first sample, and one more: the number of samples
    std::vector<SampleLocation> locations;
    /// Position, metres, or unit direction into the sky; not a number for samples that are evicted.
    std::vector<Vec3> inWorld;
    std::vector<Vec2> places;  ///< on the screen, continuous pixels
    std::vector<uint8_t> flags;
    std::vector<SampleNote> notes;
    /// Scene-linear: emission and light that met one surface, this frame's or its mean since nothing moves.
    std::vector<Vec3> direct;
    std::vector<Vec3> indirect;        ///< running average; empty: paths ended at the first surface
    std::weak_ptr<const Scene> scene;  ///< that positions are of

    size_t size() const { return locations.size(); }
    Vec3 radiance(size_t i) const { return indirect.empty() ? direct[i] : direct[i] + indirect[i]; }
    /// `withIndirect`: there is indirect light. What vectors hold is not defined then.
    void resize(size_t count, bool withIndirect) {
        resizeAnew(locations, count), resizeAnew(inWorld, count), resizeAnew(places, count), resizeAnew(flags, count);
        resizeAnew(notes, count), resizeAnew(direct, count), resizeAnew(indirect, withIndirect ? count : 0);
    }
    /// That it holds.
    size_t bytes() const {
        return heldBytes(words) + heldBytes(first) + heldBytes(locations) + heldBytes(inWorld) + heldBytes(places) +
               heldBytes(flags) + heldBytes(notes) + heldBytes(direct) + heldBytes(indirect);
    }
    static constexpr size_t bytesASample(bool withIndirect) {
        return sizeof(SampleLocation) + sizeof(Vec2) + 1 + sizeof(SampleNote) + sizeof(Vec3) * (withIndirect ? 3 : 2);
    }
};

}  // namespace lumi
