#include "trace/sampler.h"

#include <array>

#include "trace/blue_noise.h"
#include "trace/sampler_kernels.h"
#include "trace/sobol.h"

namespace lumi {
namespace {

/// Scrambled (0,2)-pairs of one sample and pair of dimensions.
class SobolPair {
public:
    SobolPair(uint32_t index, uint32_t scramble, uint32_t pair) {
        const uint64_t seeds = sobolSeeds(scramble, pair);
        seedX_ = static_cast<uint32_t>(seeds), seedY_ = static_cast<uint32_t>(seeds >> 32);
        shuffled_ = sobolShuffled(index, seedX_, seedY_);
    }
    float x() const { return static_cast<float>(sobolX(shuffled_, seedX_)) * 0x1p-24f; }
    float y() const { return static_cast<float>(sobolY(shuffled_, seedY_)) * 0x1p-24f; }

private:
    uint32_t seedX_ = 0, seedY_ = 0, shuffled_ = 0;
};

constexpr int kHaltonDimensions = 128;

constexpr std::array<uint16_t, kHaltonDimensions> firstPrimes() {
    std::array<uint16_t, kHaltonDimensions> primes{};
    int count = 0;
    for (uint16_t candidate = 2; count < kHaltonDimensions; ++candidate) {
        bool isPrime = true;
        for (int i = 0; i < count && primes[i] * primes[i] <= candidate; ++i) isPrime &= candidate % primes[i] != 0;
        if (isPrime) primes[count++] = candidate;
    }
    return primes;
}
constexpr auto kPrimes = firstPrimes();

float independent(uint32_t index, uint32_t scramble, uint32_t dimension) {
    return unitFloat(static_cast<uint32_t>(mixBits(mixBits((uint64_t(scramble) << 32) | index) + dimension) >> 32));
}

/// Radical inverse in the prime base of the dimension, rotated by a number of the pixel's own.
float halton(uint32_t index, uint32_t scramble, uint32_t dimension) {
    if (dimension >= kHaltonDimensions) return independent(index, scramble, dimension);
    const uint32_t base = kPrimes[dimension];
    uint64_t reversed = 0, power = 1;
    while (index != 0) {
        const uint32_t rest = index / base;
        reversed = reversed * base + (index - rest * base);
        power *= base;
        index = rest;
    }
    // In 24-bit fixed point, so that the rotation wraps exactly and 1 is never reached.
    const double inverse = static_cast<double>(reversed) / static_cast<double>(power);
    const uint32_t rotation = hashCombine(scramble, dimension) >> 8;
    const uint32_t sum = (static_cast<uint32_t>(inverse * 0x1p24) + rotation) & 0xffffffu;
    return static_cast<float>(sum) * 0x1p-24f;
}

/// `base` moved on around the circle by what the tile holds at the pixel. Every dimension reads the tile at a place of
/// its own, far from those of its neighbours: the R2 sequence [Roberts 2018], moved as a whole by the seed.
float rotated(float base, uint32_t x, uint32_t y, uint32_t scramble, uint32_t dimension) {
    static_assert(BlueNoiseTile::kSide == 1 << 6);
    constexpr uint32_t kStepX = 0xc13fa9a9u, kStepY = 0x91e10da6u;  // the sequence's steps, of a side of 2^32
    const uint32_t placeX = scramble + (dimension * kStepX >> 26),
                   placeY = (scramble >> 16) + (dimension * kStepY >> 26);
    const float sum = base + BlueNoiseTile::instance().at(x + placeX, y + placeY);
    return sum < 1 ? sum : sum - 1;
}

}  // namespace

SampleStream::SampleStream(SamplerKind kind, int haltonLoop, uint32_t seed, const RandomKey& key)
    : kind_(kind), scramble_(hashCombine(key.x, key.y, seed)), index_(key.sample), x_(key.x), y_(key.y) {
    if (kind == SamplerKind::BlueNoise) scramble_ = pcgHash(seed);
    if (kind == SamplerKind::Halton && haltonLoop > 0) index_ %= static_cast<uint32_t>(haltonLoop);
}

float SampleStream::get1(uint32_t dimension) const {
    switch (kind_) {
        case SamplerKind::Halton: return halton(index_, scramble_, dimension);
        case SamplerKind::Independent: return independent(index_, scramble_, dimension);
        case SamplerKind::Sobol:
        case SamplerKind::BlueNoise: break;
    }
    const SobolPair pair(index_, scramble_, dimension >> 1);
    const float value = (dimension & 1u) != 0 ? pair.y() : pair.x();
    return kind_ == SamplerKind::Sobol ? value : rotated(value, x_, y_, scramble_, dimension);
}

Vec2 SampleStream::get2(uint32_t dimension) const {
    switch (kind_) {
        case SamplerKind::Halton:
            return {halton(index_, scramble_, dimension), halton(index_, scramble_, dimension + 1)};
        case SamplerKind::Independent:
            return {independent(index_, scramble_, dimension), independent(index_, scramble_, dimension + 1)};
        case SamplerKind::Sobol:
        case SamplerKind::BlueNoise: break;
    }
    const SobolPair pair(index_, scramble_, dimension >> 1);
    if (kind_ == SamplerKind::Sobol) return {pair.x(), pair.y()};
    return {rotated(pair.x(), x_, y_, scramble_, dimension), rotated(pair.y(), x_, y_, scramble_, dimension + 1)};
}

}  // namespace lumi
