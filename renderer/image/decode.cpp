#include "image/decode.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string_view>

#include "base/error.h"
#include "base/memory.h"
#include "image/jpeg_guard.h"

// Private to this file: other libraries of the program carry their own copy.
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_NO_STDIO
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_ONLY_BMP
#define STBI_ONLY_TGA
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wsign-compare"
#include <stb_image.h>
#pragma GCC diagnostic pop

namespace lumi {
namespace {

static_assert(STBI_MAX_DIMENSIONS > kMaxDecodedSide);  // who is refused here is told why

/// Pixels a byte of any of these formats can stand for (one-bit PNG under deflate's best ratio of 1032); beyond it the
/// header lies.
constexpr uint64_t kMaxPixelsPerByte = 8 * 1032;

int lengthOf(std::span<const uint8_t> bytes, const std::string& name) {
    if (bytes.size() > INT32_MAX) throwBadInput({"image is too large", name, "at most 2 GiB", ""});
    return static_cast<int>(bytes.size());
}

[[noreturn]] void throwUnreadable(const std::string& name) {
    const char* reason = stbi_failure_reason();
    throwBadInput({fmt::format("not a readable image ({})", reason ? reason : "no reason given"), name,
                   "PNG, JPEG, BMP or TGA", ""});
}

/// Big-endian.
uint32_t word(std::span<const uint8_t> bytes, size_t at) {
    return uint32_t(bytes[at]) << 24 | uint32_t(bytes[at + 1]) << 16 | uint32_t(bytes[at + 2]) << 8 | bytes[at + 3];
}

void checkSides(uint32_t width, uint32_t height, const std::string& name) {
    const auto isGood = [](uint32_t side) { return side > 0 && side <= static_cast<uint32_t>(kMaxDecodedSide); };
    if (!isGood(width) || !isGood(height))
        throwBadInput({"image has an impossible size", name, fmt::format("1 to {} a side", kMaxDecodedSide),
                       fmt::format("{}x{}", width, height)});
}

/// The reader takes a PNG with a header that it refuses for no image at all.
void checkPngHeader(std::span<const uint8_t> bytes, const std::string& name) {
    constexpr std::string_view kMagic("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16);
    constexpr uint64_t kMaxValues = uint64_t(1) << 30;  // of the reader
    if (bytes.size() < 26 || !std::equal(kMagic.begin(), kMagic.end(), bytes.begin(),
                                         [](char a, uint8_t b) { return static_cast<uint8_t>(a) == b; }))
        return;
    const uint32_t width = word(bytes, 16), height = word(bytes, 20);
    checkSides(width, height, name);
    const uint8_t colour = bytes[25];
    const uint64_t channels = (colour & 1 ? 4u : colour & 2 ? 3u : 1u) + (colour & 4 ? 1u : 0u);
    if (uint64_t(width) * height > kMaxValues / channels)
        throwBadInput({"image is too large", name, fmt::format("at most {} pixels", kMaxValues / channels),
                       fmt::format("{}x{}", width, height)});
}

}  // namespace

Extent2 encodedExtent(std::span<const uint8_t> bytes, const std::string& name) {
    checkJpegTables(bytes, name);
    checkPngHeader(bytes, name);
    Extent2 extent;
    int channels = 0;
    if (!stbi_info_from_memory(bytes.data(), lengthOf(bytes, name), &extent.width, &extent.height, &channels))
        throwUnreadable(name);
    checkSides(static_cast<uint32_t>(extent.width), static_cast<uint32_t>(extent.height), name);
    return extent;
}

Image8 decodeImage8(std::span<const uint8_t> bytes, const std::string& name) {
    const Extent2 extent = encodedExtent(bytes, name);
    const auto area = static_cast<uint64_t>(extent.area());
    if (area / kMaxPixelsPerByte > bytes.size())
        throwBadInput({"image is too small for its size in pixels", name, "",
                       fmt::format("{}x{} pixels in {} bytes", extent.width, extent.height, bytes.size())});
    checkMemory(fmt::format("{}: {}x{} pixels", name, extent.width, extent.height), area * 8);
    Image8 image;
    int channels = 0;
    const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> pixels(
        stbi_load_from_memory(bytes.data(), lengthOf(bytes, name), &image.extent.width, &image.extent.height, &channels,
                              4),
        stbi_image_free);
    if (!pixels) throwUnreadable(name);
    image.rgba.assign(pixels.get(), pixels.get() + static_cast<size_t>(image.extent.area()) * 4);
    return image;
}

}  // namespace lumi
