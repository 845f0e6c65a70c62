#include "image/hdr.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <string_view>

#include "base/error.h"
#include "base/memory.h"

namespace lumi {
namespace {

constexpr int kMaxSide = 65536;

/// Reader of one Radiance file [Ward 1991, "Real Pixels"; format of the Radiance reference manual].
class HdrReader {
public:
    HdrReader(std::span<const uint8_t> bytes, const std::string& name) : bytes_(bytes), name_(name) {}

    Image read() {
        readHeader();
        readResolution();
        // A run-length coded line takes at least 4 bytes and a pair for each 127 pixels of a channel.
        const auto lines = static_cast<uint64_t>(lines_), columns = static_cast<uint64_t>(columns_);
        if (lines * (columns / 32) > bytes_.size()) fail("is too small for its size in pixels");
        checkMemory(fmt::format("{}: {}x{} pixels", name_, columns_, lines_), lines * columns * 12);
        Image image(rowMajor_ ? Extent2{columns_, lines_} : Extent2{lines_, columns_}, 3);
        std::vector<uint8_t> line(columns * 4);
        for (int i = 0; i < lines_; ++i) {
            readLine(line);
            store(image, i, line);
        }
        return image;
    }

private:
    [[noreturn]] void fail(const std::string& what) const { throwBadInput({what, name_, "", ""}); }

    uint8_t next() {
        if (position_ >= bytes_.size()) fail("Radiance file ends early");
        return bytes_[position_++];
    }

    std::string textLine() {
        std::string line;
        for (char c = static_cast<char>(next()); c != '\n'; c = static_cast<char>(next())) {
            line += c;
            if (line.size() > 65536) fail("not a Radiance file");
        }
        if (!line.empty() && line.back() == '\r') line.pop_back();
        return line;
    }

    void readHeader() {
        const std::string magic = textLine();
        if (!magic.starts_with("#?")) fail("not a Radiance file");
        for (std::string line = textLine(); !line.empty(); line = textLine()) {
            if (line.starts_with("FORMAT=") && line != "FORMAT=32-bit_rle_rgbe")
                throwBadInput({"Radiance file has another pixel format", name_, "32-bit_rle_rgbe", line.substr(7)});
            if (line.starts_with("EXPOSURE=")) divide(std::strtof(line.c_str() + 9, nullptr), Vec3(1));
            if (line.starts_with("COLORCORR=")) {
                Vec3 factor(1);
                char* end = line.data() + 10;
                for (int c = 0; c < 3; ++c) factor[c] = std::strtof(end, &end);
                divide(1, factor);
            }
        }
    }

    void divide(float factor, Vec3 factors) {
        factors *= factor;
        for (int c = 0; c < 3; ++c)
            if (std::isfinite(factors[c]) && factors[c] > 0) scale_[c] /= factors[c];
    }

    /// "-Y 512 +X 1024": the first axis counts lines; -Y is top to bottom, +X left to right.
    void readResolution() {
        const std::string line = textLine();
        char sign[2] = {}, axis[2] = {};
        int size[2] = {};
        if (std::sscanf(line.c_str(), "%c%c %d %c%c %d", &sign[0], &axis[0], &size[0], &sign[1], &axis[1], &size[1]) !=
                6 ||
            !((axis[0] == 'Y' && axis[1] == 'X') || (axis[0] == 'X' && axis[1] == 'Y')))
            throwBadInput({"Radiance file has no resolution line", name_, "\"-Y 512 +X 1024\"", '"' + line + '"'});
        if (size[0] < 1 || size[1] < 1 || size[0] > kMaxSide || size[1] > kMaxSide)
            throwBadInput({"image has an impossible size", name_, fmt::format("1 to {} a side", kMaxSide), line});
        rowMajor_ = axis[0] == 'Y';
        lines_ = size[0], columns_ = size[1];
        flipLines_ = sign[0] == (rowMajor_ ? '+' : '-');
        flipColumns_ = sign[1] == (rowMajor_ ? '-' : '+');
    }

    void readLine(std::vector<uint8_t>& line) {
        const std::array<uint8_t, 4> head{next(), next(), next(), next()};
        const bool coded = head[0] == 2 && head[1] == 2 && head[2] < 128 && columns_ >= 8 && columns_ < 32768;
        if (!coded) return readOldLine(line, head);
        if (head[2] * 256 + head[3] != columns_) fail("Radiance file has a line of another length");
        for (size_t channel = 0; channel < 4; ++channel) {
            for (int x = 0; x < columns_;) {
                const int code = next();
                const int count = code > 128 ? code - 128 : code;
                if (count == 0 || x + count > columns_) fail("Radiance file has a run past its line's end");
                uint8_t value = code > 128 ? next() : uint8_t(0);
                for (int i = 0; i < count; ++i, ++x) {
                    if (code <= 128) value = next();
                    line[static_cast<size_t>(x) * 4 + channel] = value;
                }
            }
        }
    }

    /// Flat pixels; (1, 1, 1, n) repeats the one before n times, and again n << 8 times if it comes twice.
    void readOldLine(std::vector<uint8_t>& line, std::array<uint8_t, 4> pixel) {
        int shift = 0;
        for (int x = 0; x < columns_;) {
            if (pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1 && x > 0) {
                const int64_t count = int64_t(pixel[3]) << shift;
                if (x + count > columns_) fail("Radiance file has a run past its line's end");
                for (int64_t i = 0; i < count; ++i, ++x)
                    for (size_t c = 0; c < 4; ++c) line[size_t(x) * 4 + c] = line[size_t(x - 1) * 4 + c];
                shift = shift < 24 ? shift + 8 : 24;
            } else {
                for (size_t c = 0; c < 4; ++c) line[size_t(x) * 4 + c] = pixel[c];
                ++x;
                shift = 0;
            }
            if (x < columns_) pixel = {next(), next(), next(), next()};
        }
    }

    void store(Image& image, int index, const std::vector<uint8_t>& line) const {
        for (int i = 0; i < columns_; ++i) {
            const uint8_t* pixel = line.data() + static_cast<size_t>(i) * 4;
            const float unit = pixel[3] ? std::ldexp(1.0f, pixel[3] - 136) : 0.0f;
            const int along = flipColumns_ ? columns_ - 1 - i : i, across = flipLines_ ? lines_ - 1 - index : index;
            for (int c = 0; c < 3; ++c)
                image.at(c, rowMajor_ ? along : across, rowMajor_ ? across : along) =
                    static_cast<float>(pixel[c]) * unit * scale_[c];
        }
    }

    std::span<const uint8_t> bytes_;
    std::string name_;
    size_t position_ = 0;
    Vec3 scale_{1};
    bool rowMajor_ = true, flipLines_ = false, flipColumns_ = false;
    int lines_ = 0, columns_ = 0;
};

}  // namespace

Image decodeHdr(std::span<const uint8_t> bytes, const std::string& name) { return HdrReader(bytes, name).read(); }

}  // namespace lumi
