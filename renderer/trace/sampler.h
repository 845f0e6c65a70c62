#pragma once
#include "trace/ray.h"
#include "trace/settings.h"

namespace lumi {

/// The random numbers of one path: pure functions of (key, dimension, seed). Cheap to copy.
///   Sobol: Owen-scrambled (0,2)-pairs, padded, with a hash-based scramble and shuffle for each pixel and pair of
///     dimensions [Burley 2020, "Practical Hash-based Owen Scrambling"].
///   Halton: bases 2, 3, 5, ... with a Cranley-Patterson rotation for each pixel; the index wraps at the loop length.
///   Independent: hashed, for tests of statistics.
class SampleStream {
public:
    SampleStream() = default;
    SampleStream(SamplerKind kind, int haltonLoop, uint32_t seed, const RandomKey& key);

    /// Number in [0, 1) of dimension `dimension`; get2 takes dimensions `dimension` and `dimension + 1` as a
    /// well-stratified pair and wants an even dimension.
    float get1(uint32_t dimension) const;
    Vec2 get2(uint32_t dimension) const;

private:
    SamplerKind kind_ = SamplerKind::Sobol;
    uint32_t scramble_ = 0;  ///< hash of key and seed
    uint32_t index_ = 0;     ///< sample index, wrapped for Halton
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
