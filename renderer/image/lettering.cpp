#include "image/lettering.h"

#include <cmath>

#include "base/error.h"
#include "base/files.h"

// Private to this file: other libraries of the program carry their own copy.
#define STBTT_STATIC
#define STB_TRUETYPE_IMPLEMENTATION
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wsign-compare"
#include <stb_truetype.h>
#pragma GCC diagnostic pop

namespace lumi {
namespace {

constexpr uint32_t kReplacement = 0xfffd;

/// The files of a weight, the best first (Debian's fonts-inter, fonts-dejavu-core).
std::vector<const char*> filesOf(Lettering::Weight weight) {
    if (weight == Lettering::Weight::Strong)
        return {"/usr/share/fonts/opentype/inter/Inter-SemiBold.otf",
                "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf"};
    return {"/usr/share/fonts/opentype/inter/Inter-Regular.otf", "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"};
}

void blend(uint8_t& channel, uint8_t colour, int coverage) {
    channel = static_cast<uint8_t>((channel * (255 - coverage) + colour * coverage + 127) / 255);
}

}  // namespace

struct Lettering::Font {
    std::vector<uint8_t> bytes;
    stbtt_fontinfo info{};
    float scale(double size) const { return stbtt_ScaleForMappingEmToPixels(&info, static_cast<float>(size)); }
    double advance(uint32_t character, uint32_t next, double size) const {
        int advance = 0, bearing = 0;
        stbtt_GetCodepointHMetrics(&info, static_cast<int>(character), &advance, &bearing);
        const int kern =
            next ? stbtt_GetCodepointKernAdvance(&info, static_cast<int>(character), static_cast<int>(next)) : 0;
        return double(advance + kern) * double(scale(size));
    }
};

Lettering::Lettering(std::unique_ptr<Font> font) : font_(std::move(font)) {}
Lettering::~Lettering() = default;

const Lettering* Lettering::find(Weight weight) {
    const auto load = [](Weight wanted) -> std::unique_ptr<Lettering> {
        for (const char* path : filesOf(wanted)) {
            auto font = std::make_unique<Font>();
            try {
                font->bytes = readFile(path);
            } catch (const Error&) {
                continue;  // not installed
            }
            if (stbtt_InitFont(&font->info, font->bytes.data(), stbtt_GetFontOffsetForIndex(font->bytes.data(), 0)))
                return std::unique_ptr<Lettering>(new Lettering(std::move(font)));
        }
        return nullptr;
    };
    static const std::unique_ptr<Lettering> regular = load(Weight::Regular), strong = load(Weight::Strong);
    return weight == Weight::Strong ? strong.get() : regular.get();
}

double Lettering::width(const std::string& text, double size) const {
    const std::vector<uint32_t> characters = decodeUtf8(text);
    double width = 0;
    for (size_t i = 0; i < characters.size(); ++i)
        width += font_->advance(characters[i], i + 1 < characters.size() ? characters[i + 1] : 0, size);
    return width;
}

void Lettering::draw(Image8& image, double x, double baseline, double size, const std::string& text,
                     Colour8 colour) const {
    const std::vector<uint32_t> characters = decodeUtf8(text);
    const float scale = font_->scale(size);
    for (size_t i = 0; i < characters.size(); ++i) {
        const int left = static_cast<int>(std::floor(x));
        int width = 0, height = 0, offsetX = 0, offsetY = 0;
        unsigned char* glyph =
            stbtt_GetCodepointBitmapSubpixel(&font_->info, scale, scale, static_cast<float>(x - left), 0,
                                             static_cast<int>(characters[i]), &width, &height, &offsetX, &offsetY);
        for (int row = 0; row < height; ++row)
            for (int column = 0; column < width; ++column) {
                const int px = left + offsetX + column, py = static_cast<int>(std::lround(baseline)) + offsetY + row;
                if (px < 0 || py < 0 || px >= image.extent.width || py >= image.extent.height) continue;
                uint8_t* pixel =
                    image.rgba.data() +
                    4 * (static_cast<size_t>(py) * static_cast<size_t>(image.extent.width) + static_cast<size_t>(px));
                const int coverage = glyph[row * width + column];
                blend(pixel[0], colour.r, coverage), blend(pixel[1], colour.g, coverage),
                    blend(pixel[2], colour.b, coverage);
            }
        stbtt_FreeBitmap(glyph, nullptr);
        x += font_->advance(characters[i], i + 1 < characters.size() ? characters[i + 1] : 0, size);
    }
}

std::vector<uint32_t> decodeUtf8(const std::string& text) {
    std::vector<uint32_t> characters;
    for (size_t i = 0; i < text.size();) {
        const auto byte = [&](size_t at) { return at < text.size() ? static_cast<uint8_t>(text[at]) : 0u; };
        const uint32_t first = byte(i);
        const size_t length = first < 0x80 ? 1 : first >> 5 == 6 ? 2 : first >> 4 == 14 ? 3 : first >> 3 == 30 ? 4 : 0;
        uint32_t character = length == 1 ? first : length ? first & (0x7fu >> length) : 0;
        bool good = length > 0;
        for (size_t k = 1; k < length; ++k) {
            good = good && byte(i + k) >> 6 == 2;
            character = character << 6 | (byte(i + k) & 0x3f);
        }
        characters.push_back(good ? character : kReplacement);
        i += good ? length : 1;
    }
    return characters;
}

}  // namespace lumi
