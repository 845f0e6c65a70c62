#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "image/image.h"

namespace lumi {

/// An sRGB colour, 0 to 255 each.
struct Colour8 {
    uint8_t r = 0, g = 0, b = 0;
};

/// Draws text into images with a font of the system: Inter, else DejaVu Sans. For figures that go to files; the window
/// has its own.
class Lettering {
public:
    enum class Weight { Regular, Strong };
    /// Null where neither font is installed. Fonts are read once.
    static const Lettering* find(Weight weight);

    ~Lettering();
    Lettering(const Lettering&) = delete;
    Lettering& operator=(const Lettering&) = delete;

    /// Advance of UTF-8 text in pixels, at `size` pixels from line to line less the gap (an em). Bytes that are not
    /// UTF-8 stand for the replacement character.
    double width(const std::string& text, double size) const;
    /// Draws text that begins at `x` on `baseline`, in pixels from the top left. What is beyond the image is cut off.
    void draw(Image8& image, double x, double baseline, double size, const std::string& text, Colour8 colour) const;

private:
    struct Font;
    explicit Lettering(std::unique_ptr<Font> font);
    std::unique_ptr<Font> font_;
};

/// Unicode of UTF-8 text.
std::vector<uint32_t> decodeUtf8(const std::string& text);

}  // namespace lumi
