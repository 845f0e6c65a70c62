#include <png.h>

#include <cassert>
#include <csetjmp>

#include "base/error.h"
#include "base/files.h"
#include "image/png.h"

namespace lumi {
namespace {

void append(png_structp png, png_bytep bytes, size_t count) {
    auto& out = *static_cast<std::vector<uint8_t>*>(png_get_io_ptr(png));
    out.insert(out.end(), bytes, bytes + count);
}

void flush(png_structp) {}

/// Text chunks are iTXt: UTF-8; compressed where that pays.
std::vector<png_text> textChunks(const PngTexts& texts) {
    std::vector<png_text> chunks;
    for (const auto& [key, value] : texts) {
        png_text chunk{};
        chunk.compression = value.size() > 1024 ? PNG_ITXT_COMPRESSION_zTXt : PNG_ITXT_COMPRESSION_NONE;
        chunk.key = const_cast<char*>(key.c_str());
        chunk.text = const_cast<char*>(value.c_str());
        chunk.itxt_length = value.size();
        chunks.push_back(chunk);
    }
    return chunks;
}

/// Writes everything; false if libpng gave up. Holds no object with a destructor, as libpng leaves by longjmp.
bool writeAll(png_structp png, png_infop info, const Image8& image, PngAlpha alpha, std::vector<png_text>& chunks) {
    if (setjmp(png_jmpbuf(png))) return false;
    const auto width = static_cast<png_uint_32>(image.extent.width);
    const auto height = static_cast<png_uint_32>(image.extent.height);
    const int colourType = alpha == PngAlpha::Keep ? PNG_COLOR_TYPE_RGBA : PNG_COLOR_TYPE_RGB;
    png_set_IHDR(png, info, width, height, 8, colourType, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    if (!chunks.empty()) png_set_text(png, info, chunks.data(), static_cast<int>(chunks.size()));
    png_set_compression_level(png, 6);
    png_set_text_compression_level(png, 9);
    png_set_filter(png, 0, PNG_FILTER_SUB | PNG_FILTER_UP);
    png_write_info(png, info);
    if (alpha == PngAlpha::Drop) png_set_filler(png, 0, PNG_FILLER_AFTER);
    for (png_uint_32 y = 0; y < height; ++y) png_write_row(png, image.rgba.data() + size_t(4) * width * y);
    png_write_end(png, info);
    return true;
}

}  // namespace

std::vector<uint8_t> encodePng(const Image8& image, const PngTexts& texts, PngAlpha alpha) {
    assert(!image.extent.empty() && image.rgba.size() == static_cast<size_t>(image.extent.area()) * 4);
    std::vector<uint8_t> bytes;
    std::string reason;
    png_structp png = png_create_write_struct(
        PNG_LIBPNG_VER_STRING, &reason,
        [](png_structp self, png_const_charp text) {
            static_cast<std::string*>(png_get_error_ptr(self))->assign(text);
            png_longjmp(self, 1);
        },
        [](png_structp, png_const_charp) {});
    png_infop info = png ? png_create_info_struct(png) : nullptr;
    if (!info) throw std::bad_alloc();
    png_set_write_fn(png, &bytes, append, flush);
    std::vector<png_text> chunks = textChunks(texts);
    const bool done = writeAll(png, info, image, alpha, chunks);
    png_destroy_write_struct(&png, &info);
    if (!done) throw Error(ErrorKind::Usage, {"cannot be stored as PNG (" + reason + ")", "", "", ""});
    return bytes;
}

void writePng(const std::filesystem::path& path, const Image8& image, const PngTexts& texts, PngAlpha alpha) {
    writeFileAtomically(path, encodePng(image, texts, alpha));
}

}  // namespace lumi
