#pragma once
#include <cstdint>

#include "math/hash.h"

/// Owen-scrambled (0,2)-pairs [Burley 2020], for the sampler and its kernels alike: everything here has internal
/// linkage, each instruction set compiles its own copy.
///
/// Bits of an index or a coordinate are kept "digits first": bit k is the k-th digit after the binary point. Owen
/// scrambling lets each digit be flipped by a hash of the digits before it; digits first, a product or a sum carries
/// only from earlier digits to later ones, so that a few of them make such a hash.
namespace lumi {
namespace {

[[maybe_unused]] inline uint32_t reverseBits(uint32_t v) {
    v = (v << 16) | (v >> 16);
    v = ((v & 0x00ff00ffu) << 8) | ((v >> 8) & 0x00ff00ffu);
    v = ((v & 0x0f0f0f0fu) << 4) | ((v >> 4) & 0x0f0f0f0fu);
    v = ((v & 0x33333333u) << 2) | ((v >> 2) & 0x33333333u);
    return ((v & 0x55555555u) << 1) | ((v >> 1) & 0x55555555u);
}

/// Nested uniform scramble of digits [Laine & Karras 2011; Burley 2020], with the multipliers that Vegdahl searched
/// for ("Building a Better LK Hash", psychopath.io, 2021, final version).
[[maybe_unused]] inline uint32_t owenScramble(uint32_t digits, uint32_t seed) {
    digits ^= digits * 0x3d20adeau;
    digits += seed;
    digits *= (seed >> 16) | 1u;
    digits ^= digits * 0x05526c56u;
    return digits ^ (digits * 0x53a22864u);
}

/// Digits of the second Sobol dimension for the index whose bits are given, lowest first: digit k is the parity of all
/// index bits j with binomial(j, k) odd, which by Lucas are the j whose bits contain those of k. One fold a bit of j.
[[maybe_unused]] inline uint32_t sobolSecondDigits(uint32_t index) {
    index ^= (index >> 1) & 0x55555555u;
    index ^= (index >> 2) & 0x33333333u;
    index ^= (index >> 4) & 0x0f0f0f0fu;
    index ^= (index >> 8) & 0x00ff00ffu;
    return index ^ (index >> 16);
}

/// The seeds of a pair's two dimensions: the low word is x's, the high word y's.
[[maybe_unused]] inline uint64_t sobolSeeds(uint32_t scramble, uint32_t pair) {
    return mixBits((uint64_t(scramble) << 32) | pair);
}

/// Index of the sample in the pair's own order: an Owen scramble too, so that blocks of a power of two stay blocks.
[[maybe_unused]] inline uint32_t sobolShuffled(uint32_t index, uint32_t seedX, uint32_t seedY) {
    return reverseBits(owenScramble(reverseBits(index), pcgHash(seedX ^ seedY)));
}

// 24 bits of each; the first Sobol dimension's digits are the bits of the index itself.
[[maybe_unused]] inline uint32_t sobolX(uint32_t shuffled, uint32_t seedX) {
    return reverseBits(owenScramble(shuffled, seedX)) >> 8;
}
[[maybe_unused]] inline uint32_t sobolY(uint32_t shuffled, uint32_t seedY) {
    return reverseBits(owenScramble(sobolSecondDigits(shuffled), seedY)) >> 8;
}

}  // namespace
}  // namespace lumi
