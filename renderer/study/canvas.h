#pragma once
#include <string>
#include <vector>

#include "base/messages.h"
#include "image/image.h"
#include "image/lettering.h"

namespace lumi {

/// A drawing of pictures, outlines and text, in units of a pixel at scale 1 from the top left; later things lie above
/// earlier ones. One drawing becomes SVG and PNG alike.
struct Canvas {
    struct Picture {
        double x = 0, y = 0, width = 0, height = 0;
        Image8 pixels;
    };
    struct Outline {
        double x = 0, y = 0, width = 0, height = 0;
        Colour8 colour;
        double line = 2;  ///< thickness, inside the box
    };
    enum class Align { Left, Middle, Right };
    struct Text {
        double x = 0, baseline = 0;
        std::string text;
        double size = 13;
        bool strong = false;
        Align align = Align::Left;
        Colour8 colour{27, 28, 30};
        bool halo = false;  ///< dark around the letters, to be read on pictures
    };

    double width = 0, height = 0;
    std::string title;  ///< for those who cannot see it
    std::vector<Picture> pictures;
    std::vector<Outline> outlines;
    std::vector<Text> texts;
};

/// Self-contained SVG: pictures as PNG inside at their own resolution, text as text.
std::string svgOf(const Canvas& canvas);

/// White paper at `scale` pixels a unit. Pixels of enlarged pictures stay squares; shrunken ones are averaged. Without
/// a font there is no text, and a warning.
Image8 rasterOf(const Canvas& canvas, double scale, MessageLog& log);

/// Averages over the area that each new pixel covers.
Image8 resampled(const Image8& image, Extent2 extent);

}  // namespace lumi
