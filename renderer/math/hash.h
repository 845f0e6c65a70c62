#pragma once
#include <cstdint>

namespace lumi {

/// Always inlined: kernels for several instruction sets use them, and no copy of one set may serve another.

/// Well-mixed 32-bit permutation [O'Neill 2014, PCG-RXS-M-XS; Jarzynski & Olano 2020].
[[gnu::always_inline]] inline uint32_t pcgHash(uint32_t value) {
    const uint32_t state = value * 747796405u + 2891336453u;
    const uint32_t word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

/// Finaliser of SplitMix64 [Steele 2014].
[[gnu::always_inline]] inline uint64_t mixBits(uint64_t v) {
    v += 0x9e3779b97f4a7c15ull;
    v = (v ^ (v >> 30)) * 0xbf58476d1ce4e5b9ull;
    v = (v ^ (v >> 27)) * 0x94d049bb133111ebull;
    return v ^ (v >> 31);
}

[[gnu::always_inline]] inline uint32_t hashCombine(uint32_t a, uint32_t b) {
    return static_cast<uint32_t>(mixBits((uint64_t(a) << 32) | b));
}
[[gnu::always_inline]] inline uint32_t hashCombine(uint32_t a, uint32_t b, uint32_t c) {
    return hashCombine(hashCombine(a, b), c);
}

/// 24 bits to [0, 1), never 1.
[[gnu::always_inline]] inline float unitFloat(uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; }

}  // namespace lumi
