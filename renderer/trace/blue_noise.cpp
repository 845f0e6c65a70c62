#include "trace/blue_noise.h"

#include <algorithm>
#include <vector>

#include "math/hash.h"

namespace lumi {
namespace {

constexpr int kSide = BlueNoiseTile::kSide, kCount = kSide * kSide;
/// Of the first, evenly spread pattern that the ranks grow from.
constexpr int kFirst = kCount / 10;

/// How crowded each pixel is: a Gaussian of 1.5 pixels around each point of a pattern, on the torus. In integers, so
/// that every machine finds the same voids.
class Crowding {
public:
    Crowding() : pattern_(kCount, 0), energy_(kCount, 0) {
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x) {
                const int dx = std::min(x, kSide - x), dy = std::min(y, kSide - y);
                kernel_[y * kSide + x] = gaussian(dx * dx + dy * dy);
            }
    }
    bool has(int pixel) const { return pattern_[static_cast<size_t>(pixel)] != 0; }
    void set(int pixel, bool on) {
        pattern_[static_cast<size_t>(pixel)] = on;
        const int px = pixel % kSide, py = pixel / kSide;
        for (int y = 0; y < kSide; ++y) {
            const int64_t* row = &kernel_[((y - py + kSide) % kSide) * kSide];
            int64_t* energy = &energy_[static_cast<size_t>(y) * kSide];
            for (int x = 0; x < kSide; ++x) {
                const int64_t share = row[(x - px + kSide) % kSide];
                energy[x] += on ? share : -share;
            }
        }
    }
    int tightestCluster() const { return extreme(1, 1); }
    int largestVoid() const { return extreme(0, -1); }

private:
    /// 2^40 exp(-d^2 / (2 1.5^2)) by repeated products of exp(-1 / 4.5) in fixed point.
    static int64_t gaussian(int distance2) {
        int64_t value = int64_t(1) << 40;
        for (int i = 0; i < distance2 && value > 0; ++i)
            value = (value >> 20) * 839634 + (((value & 0xfffff) * 839634) >> 20);
        return value;
    }
    /// The pixel of that state with the most (sign 1) or the least energy; the first of several.
    int extreme(int state, int64_t sign) const {
        int best = -1;
        for (int i = 0; i < kCount; ++i) {
            if (pattern_[static_cast<size_t>(i)] != state) continue;
            if (best < 0 || sign * energy_[static_cast<size_t>(i)] > sign * energy_[static_cast<size_t>(best)])
                best = i;
        }
        return best;
    }

    std::vector<uint8_t> pattern_;
    std::vector<int64_t> energy_;
    int64_t kernel_[kCount];
};

}  // namespace

BlueNoiseTile::BlueNoiseTile() {
    Crowding crowding;
    // A random pattern, evened out: what crowds most goes to the largest void until it would come back.
    for (int set = 0, i = 0; set < kFirst; ++i) {
        const int pixel = static_cast<int>(pcgHash(static_cast<uint32_t>(i)) % kCount);
        if (crowding.has(pixel)) continue;
        crowding.set(pixel, true);
        ++set;
    }
    for (;;) {
        const int from = crowding.tightestCluster();
        crowding.set(from, false);
        const int to = crowding.largestVoid();
        crowding.set(to, true);
        if (from == to) break;
    }
    std::vector<int> ranks(kCount, 0);
    const auto keep = [&](int pixel, int rank) { ranks[static_cast<size_t>(pixel)] = rank; };
    // Ranks below those of the first pattern, by taking it apart; then upwards into the voids. Past the middle the
    // empty pixels are the few, and their tightest cluster is the largest void of the energy that they lack.
    Crowding removing = crowding;
    for (int rank = kFirst - 1; rank >= 0; --rank) {
        const int pixel = removing.tightestCluster();
        removing.set(pixel, false);
        keep(pixel, rank);
    }
    for (int rank = kFirst; rank < kCount; ++rank) {
        const int pixel = crowding.largestVoid();
        crowding.set(pixel, true);
        keep(pixel, rank);
    }
    for (int i = 0; i < kCount; ++i) values_[i] = static_cast<float>(ranks[static_cast<size_t>(i)]) / kCount;
}

const BlueNoiseTile& BlueNoiseTile::instance() {
    static const BlueNoiseTile tile;
    return tile;
}

}  // namespace lumi
