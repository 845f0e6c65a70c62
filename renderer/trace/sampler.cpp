#include "trace/sampler.h"

#include <array>

#include "math/hash.h"
#include "trace/blue_noise.h"

namespace lumi {
namespace {

// Bits of an index or a coordinate are kept "digits first": bit k is the k-th digit after the binary point. Owen
// scrambling lets each digit be flipped by a hash of the digits before it; digits first, a product or a sum carries
// only from earlier digits to later ones, so that a few of them make such a hash.

uint32_t reverseBits(uint32_t v) {
    v = __builtin_bswap32(v);
    v = ((v & 0x0f0f0f0fu) << 4) | ((v >> 4) & 0x0f0f0f0fu);
    v = ((v & 0x33333333u) << 2) | ((v >> 2) & 0x33333333u);
    return ((v & 0x55555555u) << 1) | ((v >> 1) & 0x55555555u);
}

/// Nested uniform scramble of digits [Laine & Karras 2011; Burley 2020], with the multipliers that Vegdahl searched
/// for ("Building a Better LK Hash", psychopath.io, 2021, final version).
uint32_t owenScramble(uint32_t digits, uint32_t seed) {
    digits ^= digits * 0x3d20adeau;
    digits += seed;
    digits *= (seed >> 16) | 1u;
    digits ^= digits * 0x05526c56u;
    return digits ^ (digits * 0x53a22864u);
}

/// Digits of the second Sobol dimension for the index whose bits are given, lowest first: digit k is the parity of all
/// index bits j with binomial(j, k) odd, which by Lucas are the j whose bits contain those of k. One fold a bit of j.
uint32_t sobolSecondDigits(uint32_t index) {
    index ^= (index >> 1) & 0x55555555u;
    index ^= (index >> 2) & 0x33333333u;
    index ^= (index >> 4) & 0x0f0f0f0fu;
    index ^= (index >> 8) & 0x00ff00ffu;
    return index ^ (index >> 16);
}

/// Scrambled (0,2)-pairs of one sample and pair of dimensions. The first Sobol dimension's digits are the bits of the
/// index itself.
class SobolPair {
public:
    SobolPair(uint32_t index, uint32_t scramble, uint32_t pair) {
        const uint64_t seeds = mixBits((uint64_t(scramble) << 32) | pair);
        seedX_ = static_cast<uint32_t>(seeds), seedY_ = static_cast<uint32_t>(seeds >> 32);
        // The shuffle of the order is an Owen scramble too: blocks of a power of two stay blocks.
        shuffled_ = reverseBits(owenScramble(reverseBits(index), pcgHash(seedX_ ^ seedY_)));
    }
    float x() const { return unitFloat(reverseBits(owenScramble(shuffled_, seedX_))); }
    float y() const { return unitFloat(reverseBits(owenScramble(sobolSecondDigits(shuffled_), seedY_))); }

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

/// `base` moved on around the circle by what the tile holds at the pixel.
float rotated(float base, uint32_t x, uint32_t y, uint32_t scramble, uint32_t dimension) {
    const uint32_t shift = hashCombine(scramble, dimension);
    const float sum = base + BlueNoiseTile::instance().at(x + shift, y + (shift >> 16));
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
