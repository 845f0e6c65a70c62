#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "image/image.h"

namespace lumi {

/// Text chunks by keyword: printable Latin-1 of 1 to 79 characters; values are UTF-8. Our state as JSON is under
/// kStateKey (exr.h).
using PngTexts = std::map<std::string, std::string>;

enum class PngAlpha { Keep, Drop };

/// Bytes of an 8-bit sRGB PNG (RGBA or RGB), the same every time. Texts stand before the pixels, compressed if long.
std::vector<uint8_t> encodePng(const Image8& image, const PngTexts& texts = {}, PngAlpha alpha = PngAlpha::Drop);
void writePng(const std::filesystem::path& path, const Image8& image, const PngTexts& texts = {},
              PngAlpha alpha = PngAlpha::Drop);

/// A PNG of any kind as 16-bit RGBA, interleaved, top row first; 8-bit values are scaled by 257.
struct Png {
    Extent2 extent;
    int bitDepth = 8;    ///< of the file: 8 (also for fewer) or 16
    bool alpha = false;  ///< the file has an alpha channel or a transparent colour
    std::vector<uint16_t> rgba;
    PngTexts texts;

    /// High bytes: exact for 8-bit files.
    Image8 image8() const;
};

/// Throws Error(BadInput) naming the file: not a PNG, damaged, truncated, larger than 32768 a side.
Png decodePng(std::span<const uint8_t> bytes, const std::string& name);
Png readPng(const std::filesystem::path& path);
/// Only the texts that stand before the pixels, as ours do.
PngTexts readPngTexts(const std::filesystem::path& path);

}  // namespace lumi
