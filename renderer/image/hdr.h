#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "image/image.h"

namespace lumi {

/// Pixels of a Radiance .hdr (RGBE, flat or run-length coded, any orientation) as RGB; value = mantissa * 2^(e - 136).
/// EXPOSURE and COLORCORR lines are divided out. XYZE files are refused.
/// Throws Error(BadInput): not Radiance, damaged, truncated; Error(Resources) beyond the memory limit.
Image decodeHdr(std::span<const uint8_t> bytes, const std::string& name);

/// An image file as linear RGB by its extension: .exr (R, G, B or Y; aliases of canonicalChannel()), .hdr, and .png,
/// .jpg, .jpeg, .bmp, .tga decoded from sRGB (16-bit PNG in full precision). Throws Error(BadInput).
Image loadImage(const std::filesystem::path& path);

/// Does such a file hold linear values? If not it is a picture as shown: exposure and tone curve are in it.
bool isLinearFile(const std::filesystem::path& path);
/// Takes back the exposure that a picture as shown holds, so that exposed again it is shown as it is stored.
void takeBackExposure(Image& picture, float exposureEv);

}  // namespace lumi
