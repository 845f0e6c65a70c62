#pragma once
#include <bit>
#include <cstdint>

#include "math/vector.h"

namespace lumi {

/// The word that each pixel of a sample buffer has [DalCorso17, sec. 4.1]: the pixel is divided into 4 x 4 sub-pixels,
/// numbered along rows from the top left. Bit b of the lower half: sub-pixel b holds a sample (occupancy); of the upper
/// half: that sample is occluded. Four strata of 2 x 2 sub-pixels, numbered the same way, spread the samples.
namespace subpixel {

constexpr int kSide = 4, kCount = kSide * kSide;  ///< M and M x M
constexpr int kStrata = 4;

/// Sub-pixels of each stratum.
constexpr uint32_t kStratum[kStrata] = {0x0033, 0x00CC, 0x3300, 0xCC00};

inline uint32_t occupied(uint32_t word) { return word & 0xFFFFu; }
inline uint32_t occluded(uint32_t word) { return word >> 16; }
/// Sub-pixels with a sample that is not occluded.
inline uint32_t visible(uint32_t word) { return word & ~(word >> 16) & 0xFFFFu; }
inline uint32_t bit(int subpixel) { return 1u << subpixel; }
/// Bits set among the lower 16, without the call that std::popcount() is on machines of any age.
inline uint32_t count(uint32_t bits) {
    bits -= (bits >> 1) & 0x5555u;
    bits = (bits & 0x3333u) + ((bits >> 2) & 0x3333u);
    bits = (bits + (bits >> 4)) & 0x0F0Fu;
    return (bits + (bits >> 8)) & 0x1Fu;
}
/// Number of samples in front of that of `subpixel` in a pixel whose samples lie in the order of their bits.
inline int rank(uint32_t occupancy, int subpixel) { return static_cast<int>(count(occupancy & (bit(subpixel) - 1))); }

/// The sub-pixel of a place within a pixel, both in [0, 1).
inline int at(Vec2 within) {
    const int x = glm::clamp(static_cast<int>(within.x * kSide), 0, kSide - 1);
    const int y = glm::clamp(static_cast<int>(within.y * kSide), 0, kSide - 1);
    return y * kSide + x;
}

/// Algorithm 1: a sample lands in `subpixel` of the pixel that `word` stands for. Updates the word; true if the sample
/// is to be stored, in place of the one there if there is one. The first unoccluded sample stays, then the first
/// occluded one.
/// Differs from the print, which clears the occlusion bit of an occluded sample that lands in an empty sub-pixel: here
/// it is copied from the source, as the text says.
inline bool store(uint32_t& word, int subpixel, bool isOccluded) {
    const uint32_t occupancyBit = bit(subpixel), occlusionBit = bit(subpixel + kCount);
    const uint32_t original = word;
    word |= occupancyBit | (isOccluded ? occlusionBit : 0);
    const bool originalExists = original & occupancyBit, originalIsOccluded = original & occlusionBit;
    if (!isOccluded || (originalExists && !originalIsOccluded)) word &= ~occlusionBit;
    return !originalExists || (!isOccluded && originalIsOccluded);
}

}  // namespace subpixel
}  // namespace lumi
