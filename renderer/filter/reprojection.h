#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "filter/tap_refusal.h"
#include "frame/signals.h"
#include "params/parameter.h"

namespace lumi {

/// Where a pixel's surface point was on the previous frame's screen, and which of that frame's pixels saw the same
/// surface [Schied17, sec. 4.1].
struct ReprojectionSettings {
    float depthTolerance = 0.02f;   ///< relative, beside what the surface's own slope explains
    float normalToleranceDeg = 30;  ///< between object-space normals
    bool wideFallback = true;       ///< try 3x3 where all of 2x2 fail

    void describe(ParameterVisitor& v);
};

/// The geometry of a frame that later frames are tested against.
struct SurfaceRecord {
    Image inverseDepth;  ///< 1 channel, 1/m
    Image objectNormal;  ///< 3 channels
    IdImage objectId;

    void reset(Extent2 extent);
    /// Rows [begin, end) of a frame of this extent.
    void copyRows(const Signals& signals, int begin, int end);
    size_t bytes() const { return inverseDepth.bytes() + objectNormal.bytes() + objectId.bytes(); }
};

/// What reprojection reads.
inline SignalSet reprojectionSignals() {
    return {Signal::Depth,        Signal::DepthGradient, Signal::InverseDepth,
            Signal::ObjectNormal, Signal::ObjectId,      Signal::Motion};
}

/// The taps of the previous frame that make up a pixel's history, at most nine, with weights that sum to 1.
struct ReprojectedTaps {
    int count = 0;                   ///< 0: disocclusion
    bool wide = false;               ///< found by the 3x3 fall-back
    std::array<int32_t, 9> index{};  ///< y * width + x
    std::array<float, 9> weight{};
    std::array<uint8_t, 4> refusals{};  ///< of the 2x2 taps: (0,0) (1,0) (0,1) (1,1)
    int x0 = 0, y0 = 0;                 ///< of tap (0,0)
};

/// The 2x2 taps of a stretch of pixels, as kernels take them: four a pixel, those that are refused with weight 0.
struct ReprojectedRow {
    std::vector<int32_t> index[4], refusals[4];
    std::vector<float> weight[4];

    explicit ReprojectedRow(int pixels);
    /// Each tap of the first `count` pixels lies in memory one behind that of the pixel before.
    bool inARow(int count) const;
    /// Those of the k-th pixel (1 or later) do.
    bool follows(int k) const;
    /// Nothing of the k-th pixel's passed the tests.
    bool lost(int k) const;
    ReprojectedTaps pixel(int k) const;
};

/// Tests one frame's pixels against the previous frame's.
class Reprojection {
public:
    /// `signals` has reprojectionSignals(); both must outlive this. `previous` has the same extent.
    Reprojection(const Signals& signals, const SurfaceRecord& previous, const ReprojectionSettings& settings);
    /// 2x2 bilinear taps, each tested for depth, object-space normal and object; a refused tap's weight is spread
    /// uniformly over the others. If none is left, the pixels of 3x3 around the point that pass, in equal parts. The
    /// sky has none.
    ReprojectedTaps taps(int x, int y) const;
    /// The 2x2 taps of pixels [begin, end) of row y; where they are lost(), widen() may find others. Returns how many
    /// are.
    int row(int y, int begin, int end, ReprojectedRow& row) const;
    /// The 3x3 fall-back of a pixel that lost its 2x2 taps: count 0 if it is switched off, or finds nothing.
    ReprojectedTaps widen(int x, int y) const;

private:
    int tapRange(int y, int begin, int end, int32_t* const index[4], float* const weight[4],
                 int32_t* const refusals[4]) const;

    const Signals& signals_;
    const SurfaceRecord& previous_;
    ReprojectionSettings settings_;
    float normalCosine_;
};

/// Where verdicts are wanted as pictures: each may be null.
struct VerdictImages {
    Image* verdict = nullptr;   ///< Y, verdictValue()
    Image* refusals = nullptr;  ///< XYZW, refusalMasks()
    bool wanted() const { return verdict || refusals; }
    /// Of a frame whose history nobody looked for.
    void unused(Extent2 extent) const;
};

/// Which of the 2x2 taps were refused: for another object, depth, normal, and off screen, each a sum of 1, 2, 4 and 8
/// for the taps (0,0), (1,0), (0,1) and (1,1).
std::array<float, 4> refusalMasks(const std::array<uint8_t, 4>& refusals);

inline constexpr float kVerdictUnused = 20;

/// Verdicts as a picture: 0 sky, 1 whole history, 2 part of the taps refused, 3 the 3x3 fall-back, 4 + the common
/// refusals of all taps where history was lost (5 off screen, 6 other object, 8 depth, 12 normal, and sums of them),
/// kVerdictUnused where history is switched off.
float verdictValue(const ReprojectedTaps& taps, bool sky);

}  // namespace lumi
