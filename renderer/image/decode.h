#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "image/image.h"

namespace lumi {

inline constexpr int kMaxDecodedSide = 32768;

/// Extent of an encoded PNG, JPEG, BMP or TGA without decoding it. Throws as decodeImage8() does.
Extent2 encodedExtent(std::span<const uint8_t> bytes, const std::string& name);

/// Pixels of an encoded PNG, JPEG, BMP or TGA as stored (no colour conversion; 16-bit values lose their low byte; no
/// alpha channel gives 255). `name` heads messages. Safe on several threads at once.
/// Throws Error(BadInput): unknown format, damaged, larger than kMaxDecodedSide; Error(Resources) beyond the memory
/// limit.
Image8 decodeImage8(std::span<const uint8_t> bytes, const std::string& name);

}  // namespace lumi
