#include "image/decode.h"

#include <fmt/format.h>

#include <memory>

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
#define STBI_MAX_DIMENSIONS 32768
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wsign-compare"
#include <stb_image.h>
#pragma GCC diagnostic pop

namespace lumi {
namespace {

static_assert(STBI_MAX_DIMENSIONS == kMaxDecodedSide);

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

}  // namespace

Extent2 encodedExtent(std::span<const uint8_t> bytes, const std::string& name) {
    checkJpegTables(bytes, name);
    Extent2 extent;
    int channels = 0;
    if (!stbi_info_from_memory(bytes.data(), lengthOf(bytes, name), &extent.width, &extent.height, &channels))
        throwUnreadable(name);
    if (extent.empty() || extent.width > kMaxDecodedSide || extent.height > kMaxDecodedSide)
        throwBadInput({"image has an impossible size", name, fmt::format("1 to {} a side", kMaxDecodedSide),
                       fmt::format("{}x{}", extent.width, extent.height)});
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
