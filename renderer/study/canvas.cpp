#include "study/canvas.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "image/png.h"
#include "study/report.h"

namespace lumi {
namespace {

constexpr Colour8 kHalo{16, 17, 18};

std::string hexColour(Colour8 colour) { return fmt::format("#{:02x}{:02x}{:02x}", colour.r, colour.g, colour.b); }

int rounded(double value) { return static_cast<int>(std::lround(value)); }

/// Shares of the old pixels in each new one, along one axis.
struct Cover {
    int first = 0;
    std::vector<double> shares;
};

std::vector<Cover> coversOf(int from, int to) {
    std::vector<Cover> covers(static_cast<size_t>(to));
    const double step = double(from) / to;
    for (int i = 0; i < to; ++i) {
        const double begin = i * step, end = std::min((i + 1) * step, double(from));
        Cover& cover = covers[static_cast<size_t>(i)];
        cover.first = std::min(static_cast<int>(begin), from - 1);
        for (int k = cover.first; k < from && (k < end || k == cover.first); ++k)
            cover.shares.push_back((std::min(k + 1.0, end) - std::max(double(k), begin)) / (end - begin));
    }
    return covers;
}

void fill(Image8& image, int x0, int y0, int x1, int y1, Colour8 colour) {
    for (int y = std::max(y0, 0); y < std::min(y1, image.extent.height); ++y)
        for (int x = std::max(x0, 0); x < std::min(x1, image.extent.width); ++x) {
            uint8_t* pixel = image.rgba.data() + 4 * (size_t(y) * size_t(image.extent.width) + size_t(x));
            pixel[0] = colour.r, pixel[1] = colour.g, pixel[2] = colour.b, pixel[3] = 255;
        }
}

void paste(Image8& image, const Image8& picture, int x0, int y0) {
    for (int y = 0; y < picture.extent.height; ++y)
        for (int x = 0; x < picture.extent.width; ++x) {
            if (x0 + x < 0 || y0 + y < 0 || x0 + x >= image.extent.width || y0 + y >= image.extent.height) continue;
            const uint8_t* from = picture.rgba.data() + 4 * (size_t(y) * size_t(picture.extent.width) + size_t(x));
            uint8_t* to = image.rgba.data() + 4 * (size_t(y0 + y) * size_t(image.extent.width) + size_t(x0 + x));
            std::copy(from, from + 3, to);
        }
}

void drawOutline(Image8& image, const Canvas::Outline& box, double scale) {
    const int x0 = rounded(box.x * scale), y0 = rounded(box.y * scale);
    const int x1 = rounded((box.x + box.width) * scale), y1 = rounded((box.y + box.height) * scale);
    const int line = std::max(rounded(box.line * scale), 1);
    fill(image, x0, y0, x1, y0 + line, box.colour);
    fill(image, x0, y1 - line, x1, y1, box.colour);
    fill(image, x0, y0, x0 + line, y1, box.colour);
    fill(image, x1 - line, y0, x1, y1, box.colour);
}

void drawText(Image8& image, const Canvas::Text& text, double scale) {
    const Lettering* font = Lettering::find(text.strong ? Lettering::Weight::Strong : Lettering::Weight::Regular);
    if (!font) return;
    const double width = font->width(text.text, text.size * scale);
    const double shift = text.align == Canvas::Align::Left     ? 0
                         : text.align == Canvas::Align::Middle ? width / 2
                                                               : width;
    for (int y = -1; y <= 1 && text.halo; ++y)
        for (int x = -1; x <= 1; ++x)
            font->draw(image, (text.x + x) * scale - shift, (text.baseline + y) * scale, text.size * scale, text.text,
                       kHalo);
    font->draw(image, text.x * scale - shift, text.baseline * scale, text.size * scale, text.text, text.colour);
}

}  // namespace

Image8 resampled(const Image8& image, Extent2 extent) {
    Image8 out{extent, std::vector<uint8_t>(4 * static_cast<size_t>(extent.area()))};
    const std::vector<Cover> columns = coversOf(image.extent.width, extent.width),
                             rows = coversOf(image.extent.height, extent.height);
    for (int y = 0; y < extent.height; ++y)
        for (int x = 0; x < extent.width; ++x) {
            double sum[3] = {0, 0, 0};
            const Cover &row = rows[size_t(y)], &column = columns[size_t(x)];
            for (size_t j = 0; j < row.shares.size(); ++j)
                for (size_t i = 0; i < column.shares.size(); ++i) {
                    const size_t at = (size_t(row.first) + j) * size_t(image.extent.width) + size_t(column.first) + i;
                    for (size_t c = 0; c < 3; ++c) sum[c] += row.shares[j] * column.shares[i] * image.rgba[4 * at + c];
                }
            uint8_t* pixel = out.rgba.data() + 4 * (size_t(y) * size_t(extent.width) + size_t(x));
            for (size_t c = 0; c < 3; ++c) pixel[c] = static_cast<uint8_t>(std::clamp(rounded(sum[c]), 0, 255));
            pixel[3] = 255;
        }
    return out;
}

std::string svgOf(const Canvas& canvas) {
    std::string out = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:g} {1:g}\" width=\"{0:g}\" height=\"{1:g}\" "
        "role=\"img\" "
        "aria-label=\"{2}\" font-family=\"Inter, Helvetica, Arial, sans-serif\">\n<rect width=\"{0:g}\" "
        "height=\"{1:g}\" fill=\"#ffffff\"/>\n",
        canvas.width, canvas.height, escapedMarkup(canvas.title));
    for (const Canvas::Picture& picture : canvas.pictures) {
        // Enlarged pixels stay squares: what is between them was never computed.
        const bool enlarged = picture.width > 1.2 * picture.pixels.extent.width;
        out += fmt::format(
            "<image x=\"{:g}\" y=\"{:g}\" width=\"{:g}\" height=\"{:g}\" preserveAspectRatio=\"none\"{} "
            "href=\"data:image/png;base64,{}\"/>\n",
            picture.x, picture.y, picture.width, picture.height, enlarged ? " style=\"image-rendering:pixelated\"" : "",
            base64(encodePng(picture.pixels)));
    }
    for (const Canvas::Outline& box : canvas.outlines)
        out += fmt::format(
            "<rect x=\"{:g}\" y=\"{:g}\" width=\"{:g}\" height=\"{:g}\" fill=\"none\" stroke=\"{}\" "
            "stroke-width=\"{:g}\"/>\n",
            box.x + box.line / 2, box.y + box.line / 2, box.width - box.line, box.height - box.line,
            hexColour(box.colour), box.line);
    for (const Canvas::Text& text : canvas.texts) {
        const char* anchor = text.align == Canvas::Align::Left     ? "start"
                             : text.align == Canvas::Align::Middle ? "middle"
                                                                   : "end";
        out += fmt::format(
            "<text x=\"{:g}\" y=\"{:g}\" font-size=\"{:g}\" text-anchor=\"{}\" fill=\"{}\"{}{}>{}</text>\n", text.x,
            text.baseline, text.size, anchor, hexColour(text.colour), text.strong ? " font-weight=\"600\"" : "",
            text.halo
                ? fmt::format(" stroke=\"{}\" stroke-width=\"2.4\" stroke-linejoin=\"round\" paint-order=\"stroke\"",
                              hexColour(kHalo))
                : "",
            escapedMarkup(text.text));
    }
    return out + "</svg>\n";
}

Image8 rasterOf(const Canvas& canvas, double scale, MessageLog& log) {
    const Extent2 extent{rounded(canvas.width * scale), rounded(canvas.height * scale)};
    Image8 image{extent, std::vector<uint8_t>(4 * static_cast<size_t>(extent.area()), 255)};
    for (const Canvas::Picture& picture : canvas.pictures) {
        const int x0 = rounded(picture.x * scale), y0 = rounded(picture.y * scale);
        const Extent2 size{std::max(rounded((picture.x + picture.width) * scale) - x0, 1),
                           std::max(rounded((picture.y + picture.height) * scale) - y0, 1)};
        paste(image, resampled(picture.pixels, size), x0, y0);
    }
    for (const Canvas::Outline& box : canvas.outlines) drawOutline(image, box, scale);
    for (const Canvas::Text& text : canvas.texts) drawText(image, text, scale);
    if (!canvas.texts.empty() && !Lettering::find(Lettering::Weight::Regular))
        log.warning("figures as PNG have no text: neither Inter nor DejaVu Sans is installed");
    return image;
}

}  // namespace lumi
