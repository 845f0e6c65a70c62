#pragma once
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "image/plane_memory.h"
#include "math/vector.h"

namespace lumi {

/// A view of one channel: row-major, `stride` elements from row to row.
template <class T>
struct PlaneView {
    T* data = nullptr;
    int width = 0, height = 0;
    std::ptrdiff_t stride = 0;

    T* row(int y) const { return data + y * stride; }
    T& at(int x, int y) const { return data[y * stride + x]; }
    T& at(Pixel p) const { return at(p.x, p.y); }
    operator PlaneView<const T>() const { return {data, width, height, stride}; }
};
using FloatPlane = PlaneView<float>;
using ConstFloatPlane = PlaneView<const float>;

/// Several channels of one extent, planar, row-major, top row first. Channels are contiguous and never overlap.
template <class T>
class ImageOf {
public:
    ImageOf() = default;
    ImageOf(Extent2 extent, int channels) { reset(extent, channels); }

    /// Takes the new shape; contents are zero.
    void reset(Extent2 extent, int channels) {
        extent_ = extent;
        channels_ = channels;
        values_.assign(static_cast<size_t>(extent.area()) * static_cast<size_t>(channels), T(0));
    }
    void fill(T value) { values_.assign(values_.size(), value); }

    Extent2 extent() const { return extent_; }
    int width() const { return extent_.width; }
    int height() const { return extent_.height; }
    int channels() const { return channels_; }
    bool empty() const { return values_.empty(); }
    size_t bytes() const { return values_.size() * sizeof(T); }

    PlaneView<T> plane(int channel) {
        assert(channel < channels_);
        return {values_.data() + channel * extent_.area(), extent_.width, extent_.height, extent_.width};
    }
    PlaneView<const T> plane(int channel) const {
        assert(channel < channels_);
        return {values_.data() + channel * extent_.area(), extent_.width, extent_.height, extent_.width};
    }
    T& at(int channel, int x, int y) { return plane(channel).at(x, y); }
    const T& at(int channel, int x, int y) const { return plane(channel).at(x, y); }
    T* data() { return values_.data(); }
    const T* data() const { return values_.data(); }
    size_t size() const { return values_.size(); }
    bool operator==(const ImageOf&) const = default;

private:
    Extent2 extent_;
    int channels_ = 0;
    std::vector<T, PlaneAllocator<T>> values_;
};
using Image = ImageOf<float>;
using IdImage = ImageOf<uint32_t>;

/// Interleaved 8-bit RGBA, ready for the screen or a PNG. Top row first.
struct Image8 {
    Extent2 extent;
    std::vector<uint8_t> rgba;  ///< 4 * width * height
};

}  // namespace lumi
