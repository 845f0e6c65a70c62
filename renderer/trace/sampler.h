#pragma once
#include "trace/ray.h"
#include "trace/settings.h"

namespace lumi {

/// The random numbers of one path: pure functions of (key, dimension, seed). Cheap to copy.
///   Sobol: Owen-scrambled (0,2)-pairs, padded, with a hash-based scramble and shuffle for each pixel and pair of
///     dimensions [Burley 2020, "Practical Hash-based Owen Scrambling"].
///   Halton: bases 2, 3, 5, ... with a Cranley-Patterson rotation for each pixel; the index wraps at the loop length.
///   Independent: hashed, for tests of statistics. BlueNoise: one Owen-scrambled Sobol sequence for all pixels, rotated
///   in each by a blue-noise tile that is moved for
///     every dimension, so that neighbours err differently and the error has few low frequencies
///     [Georgiev & Fajardo 2016, "Blue-noise Dithered Sampling"]. Made for one sample a pixel and frame: over several
///     the rotated points err more than those of Sobol.
class SampleStream {
public:
    SampleStream() = default;
    SampleStream(SamplerKind kind, int haltonLoop, uint32_t seed, const RandomKey& key);

    /// Number in [0, 1) of dimension `dimension`; get2 takes dimensions `dimension` and `dimension + 1` as a
    /// well-stratified pair and wants an even dimension.
    float get1(uint32_t dimension) const;
    Vec2 get2(uint32_t dimension) const;

    /// What names the numbers of a Sobol stream; see SamplerKernels.
    uint32_t scramble() const { return scramble_; }
    uint32_t index() const { return index_; }

private:
    SamplerKind kind_ = SamplerKind::Sobol;
    uint32_t scramble_ = 0;   ///< hash of key and seed; of the seed alone for BlueNoise
    uint32_t index_ = 0;      ///< sample index, wrapped for Halton
    uint32_t x_ = 0, y_ = 0;  ///< of the key, for BlueNoise
};

/// Dimensions by use. Camera dimensions first, then kVertexDimensions for each vertex.
namespace dimension {
constexpr uint32_t kPixel = 0, kLens = 2, kTime = 4, kCamera = 6;
constexpr uint32_t kLobe = 0, kBsdf = 2, kLight = 4, kLightPoint = 6, kRoulette = 8, kVertexDimensions = 10;
inline uint32_t vertex(int depth, uint32_t use) {
    return kCamera + static_cast<uint32_t>(depth) * kVertexDimensions + use;
}
}  // namespace dimension

}  // namespace lumi
