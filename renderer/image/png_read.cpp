#include <fmt/format.h>
#include <png.h>

#include <csetjmp>
#include <cstring>

#include "base/error.h"
#include "base/files.h"
#include "base/memory.h"
#include "image/decode.h"
#include "image/png.h"

namespace lumi {
namespace {

/// What libpng reads from.
struct Source {
    std::span<const uint8_t> bytes;
    size_t position = 0;
};

void readBytes(png_structp png, png_bytep target, size_t count) {
    auto& source = *static_cast<Source*>(png_get_io_ptr(png));
    if (count > source.bytes.size() - source.position) png_error(png, "file ends early");
    std::memcpy(target, source.bytes.data() + source.position, count);
    source.position += count;
}

/// One reading of one file; frees libpng's structures whatever happens.
class Reader {
public:
    Reader(std::span<const uint8_t> bytes, const std::string& name) : name_(name), source_{bytes} {
        if (bytes.size() < 8 || png_sig_cmp(bytes.data(), 0, 8) != 0) throwBadInput({"is not a PNG", name, "", ""});
        png_ = png_create_read_struct(
            PNG_LIBPNG_VER_STRING, &reason_,
            [](png_structp self, png_const_charp text) {
                static_cast<std::string*>(png_get_error_ptr(self))->assign(text);
                png_longjmp(self, 1);
            },
            [](png_structp, png_const_charp) {});
        info_ = png_ ? png_create_info_struct(png_) : nullptr;
        if (!info_) throw std::bad_alloc();
        png_set_read_fn(png_, &source_, readBytes);
        png_set_user_limits(png_, kMaxDecodedSide, kMaxDecodedSide);
        png_set_chunk_malloc_max(png_, 256u << 20);  // an embedded state may be long
    }
    ~Reader() { png_destroy_read_struct(&png_, &info_, nullptr); }
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;

    Png read() {
        if (!readHeader()) fail();
        Png result;
        result.extent = {static_cast<int>(png_get_image_width(png_, info_)),
                         static_cast<int>(png_get_image_height(png_, info_))};
        result.bitDepth = png_get_bit_depth(png_, info_) == 16 ? 16 : 8;
        const int colourType = png_get_color_type(png_, info_);
        result.alpha = (colourType & PNG_COLOR_MASK_ALPHA) != 0 || png_get_valid(png_, info_, PNG_INFO_tRNS) != 0;
        // Deflate packs at most 1032 bytes into one.
        if (png_get_rowbytes(png_, info_) * static_cast<uint64_t>(result.extent.height) / 1032 > source_.bytes.size())
            throwBadInput({"is too small for its size in pixels", name_, "",
                           fmt::format("{}x{} pixels in {} bytes", result.extent.width, result.extent.height,
                                       source_.bytes.size())});
        const auto count = static_cast<size_t>(result.extent.area()) * 4;
        checkMemory(fmt::format("{}: {}x{} pixels", name_, result.extent.width, result.extent.height), count * 3);
        result.rgba.resize(count);
        std::vector<png_bytep> rows(static_cast<size_t>(result.extent.height));
        for (size_t y = 0; y < rows.size(); ++y)
            rows[y] =
                reinterpret_cast<png_bytep>(result.rgba.data() + y * 4 * static_cast<size_t>(result.extent.width));
        if (!readPixels(rows.data())) fail();
        result.texts = texts();
        return result;
    }

    PngTexts readTexts() {
        if (!readHeader()) fail();
        return texts();
    }

private:
    [[noreturn]] void fail() const { throwBadInput({"not a readable PNG (" + reason_ + ")", name_, "", ""}); }

    // The two below hold no object with a destructor, as libpng leaves by longjmp.
    bool readHeader() {
        if (setjmp(png_jmpbuf(png_))) return false;
        png_read_info(png_, info_);
        return true;
    }
    bool readPixels(png_bytepp rows) {
        if (setjmp(png_jmpbuf(png_))) return false;
        png_set_expand_16(png_);  // palettes, few bits and transparent colours too
        png_set_gray_to_rgb(png_);
        png_set_add_alpha(png_, 0xffff, PNG_FILLER_AFTER);
        png_set_swap(png_);  // the file is big-endian
        png_read_update_info(png_, info_);
        if (png_get_rowbytes(png_, info_) != size_t(8) * png_get_image_width(png_, info_))
            png_error(png_, "unexpected row size");
        png_read_image(png_, rows);
        png_read_end(png_, info_);
        return true;
    }

    PngTexts texts() const {
        png_textp chunks = nullptr;
        int count = 0;
        png_get_text(png_, info_, &chunks, &count);
        PngTexts result;
        for (int i = 0; i < count; ++i) {
            const png_text& chunk = chunks[i];
            const size_t length = chunk.compression > 0 ? chunk.itxt_length : chunk.text_length;
            if (chunk.text) result[chunk.key] = std::string(chunk.text, length);
        }
        return result;
    }

    std::string name_, reason_;
    Source source_;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
};

}  // namespace

Image8 Png::image8() const {
    Image8 image{extent, std::vector<uint8_t>(rgba.size())};
    for (size_t i = 0; i < rgba.size(); ++i) image.rgba[i] = static_cast<uint8_t>(rgba[i] >> 8);
    return image;
}

Png decodePng(std::span<const uint8_t> bytes, const std::string& name) { return Reader(bytes, name).read(); }
Png readPng(const std::filesystem::path& path) { return decodePng(readFile(path), path.string()); }
PngTexts readPngTexts(const std::filesystem::path& path) { return Reader(readFile(path), path.string()).readTexts(); }

}  // namespace lumi
