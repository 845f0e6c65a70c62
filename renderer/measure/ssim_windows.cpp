#include "measure/ssim_windows.h"

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include "base/parallel.h"
#include "measure/convolve.h"
#include "measure/measure_kernels.h"

namespace lumi {
namespace {

constexpr int kRowGrain = 96;  ///< window rows of a task; ten more are smoothed than it hands out

/// A tile of columns: the last eleven rows' four smoothed quantities, in a ring.
class TileRows {
public:
    TileRows(const SsimPlanes& planes, const std::vector<float>& weights) : planes_(planes), weights_(weights) {}

    /// Columns of windows [x, x + count).
    void moveTo(int x, int count) {
        x_ = x, count_ = count;
        padded_ = (count + kSsimChunk - 1) / kSsimChunk * kSsimChunk;
    }
    void add(int y) {
        fetch(planes_.a, y, a_);
        fetch(planes_.b, y, b_);
        float* out[4];
        for (int q = 0; q < 4; ++q) out[q] = ring_[static_cast<size_t>(y % kSsimWindow * 4 + q)].data();
        measureKernels().ssimSmooth(a_.data(), b_.data(), weights_.data(), out, padded_);
    }
    /// The windows whose first row is y; all their rows have been added.
    SsimSpan windows(int y) {
        const float* rows[kSsimWindow * 4];
        for (int k = 0; k < kSsimWindow; ++k)
            for (int q = 0; q < 4; ++q)
                rows[4 * k + q] = ring_[static_cast<size_t>((y + k) % kSsimWindow * 4 + q)].data();
        measureKernels().ssimRow(rows, weights_.data(), ssim_.data(), contrast_.data(), padded_);
        return {x_, y, count_, ssim_.data(), contrast_.data()};
    }

private:
    using Row = std::array<float, kSsimTile + kSsimWindow - 1>;

    /// What windows see of a row; behind its end the last value, whose windows nobody asks for.
    void fetch(ConstFloatPlane plane, int y, Row& row) const {
        const int wanted = count_ + kSsimWindow - 1;
        const float* from = plane.row(y) + x_;
        if (planes_.exposureFactor) measureKernels().encodeLdr(from, *planes_.exposureFactor, row.data(), wanted);
        else std::copy_n(from, wanted, row.data());
        std::fill(row.begin() + wanted, row.end(), row[static_cast<size_t>(wanted - 1)]);
    }

    const SsimPlanes& planes_;
    const std::vector<float>& weights_;
    int x_ = 0, count_ = 0, padded_ = 0;
    Row a_{}, b_{};
    std::array<std::array<float, kSsimTile>, kSsimWindow * 4> ring_{};
    std::array<float, kSsimTile> ssim_{}, contrast_{};
};

}  // namespace

double sumOverWindows(const SsimPlanes& planes, const std::function<double(const SsimSpan&)>& take) {
    const int width = planes.a.width - kSsimWindow + 1, height = planes.a.height - kSsimWindow + 1;
    if (width < 1 || height < 1) return 0;
    // its first half and middle are what kernels read
    const std::vector<float> weights = gaussianWeights(kSsimWindow, 1.5);
    const int tiles = (width + kSsimTile - 1) / kSsimTile;
    std::vector<double> sums(static_cast<size_t>(tiles) * static_cast<size_t>(height));
    parallelRanges(height, kRowGrain, [&](int64_t begin, int64_t end) {
        const auto rows = std::make_unique<TileRows>(planes, weights);
        for (int tile = 0; tile < tiles; ++tile) {
            rows->moveTo(tile * kSsimTile, std::min(kSsimTile, width - tile * kSsimTile));
            const int first = static_cast<int>(begin);
            for (int y = first; y < first + kSsimWindow - 1; ++y) rows->add(y);
            for (int y = first; y < end; ++y) {
                rows->add(y + kSsimWindow - 1);
                sums[static_cast<size_t>(y) * static_cast<size_t>(tiles) + static_cast<size_t>(tile)] =
                    take(rows->windows(y));
            }
        }
    });
    double sum = 0;
    for (const double part : sums) sum += part;
    return sum;
}

}  // namespace lumi
