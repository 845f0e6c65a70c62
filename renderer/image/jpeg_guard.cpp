#include "image/jpeg_guard.h"

#include "base/error.h"

namespace lumi {
namespace {

/// Marker codes [ITU T.81, table B.1].
constexpr uint8_t kHuffmanTables = 0xC4, kStartOfImage = 0xD8, kEndOfImage = 0xD9;

class SegmentWalk {
public:
    SegmentWalk(std::span<const uint8_t> bytes, const std::string& name) : bytes_(bytes), name_(name) {}

    void check() {
        if (byteAt(0) != 0xFF || nextMarker() != kStartOfImage) return;
        while (place_ < bytes_.size()) {
            const uint8_t marker = nextMarker();
            if (marker == kEndOfImage) return;
            // Stuffed bytes and restarts within coded data.
            if (marker == 0 || (marker >= 0xD0 && marker <= 0xD7)) continue;
            const size_t begin = place_, length = size_t(byteAt(begin)) << 8 | byteAt(begin + 1);
            if (marker == kHuffmanTables) checkTables(begin + 2, static_cast<int64_t>(length) - 2);
            // The data of a scan follow its header up to the next marker.
            place_ = begin + (length < 2 ? 2 : length);
        }
    }

private:
    uint8_t byteAt(size_t i) const { return i < bytes_.size() ? bytes_[i] : 0; }

    /// The code after the next run of 0xFF; the walk then stands behind it.
    uint8_t nextMarker() {
        while (place_ < bytes_.size() && bytes_[place_] != 0xFF) ++place_;
        while (place_ < bytes_.size() && bytes_[place_] == 0xFF) ++place_;
        return byteAt(place_++);
    }

    /// [T.81, B.2.4.2]: a byte of class and number, 16 counts, and that many values, table after table.
    void checkTables(size_t at, int64_t left) const {
        while (left > 0 && at < bytes_.size()) {
            int count = 0;
            for (size_t i = 1; i <= 16; ++i) count += byteAt(at + i);
            if (count > 256)
                throwBadInput({"not a readable image (damaged JPEG: a Huffman table of too many codes)", name_,
                               "at most 256", std::to_string(count)});
            at += 17 + static_cast<size_t>(count);
            left -= 17 + count;
        }
    }

    std::span<const uint8_t> bytes_;
    const std::string& name_;
    size_t place_ = 0;
};

}  // namespace

void checkJpegTables(std::span<const uint8_t> bytes, const std::string& name) { SegmentWalk(bytes, name).check(); }

}  // namespace lumi
