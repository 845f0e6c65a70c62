#pragma once
#include <cstdint>
#include <vector>

#include "measure/measure.h"

namespace lumi {

/// Two consecutive frames of one sequence, linear RGB of one extent, and what is known of how their points moved.
struct TemporalPair {
    const Image& image;  ///< the later frame
    const Image& previous;
    /// XY or XYZ of the later frame (Signal::Motion, best the reference's); null: nothing moves
    const Image* motion = nullptr;
    const Image* depth = nullptr;          ///< linear view depth of the later frame; null: no point is ever uncovered
    const Image* previousDepth = nullptr;  ///< of the earlier frame
    const Image* mask = nullptr;           ///< above 0.5 counts; null: everything
    float exposureEv = 0;                  ///< 2^EV, clamp, sRGB
};

/// A metric that needs more than one frame, for lists and help.
struct SequenceMetric {
    const char* id;
    const char* title;
    const char* definition;
    bool symmetric;      ///< the same if image and reference change places: none of them is
    const char* range;   ///< interval of its values
    const char* source;  ///< as in Metric
};
/// temporal, temporal_reprojected, lag (measure/lag.h). Of all of them lower is better.
const std::vector<SequenceMetric>& sequenceMetricCatalog();

/// Mean absolute difference of the luminances of the two tone-mapped frames, pixel by pixel: flicker on a static view.
/// Detail `nonfinite_pixels`; those count for nothing. NaN, with the reason, if no pixel counts.
/// Throws Error(BadInput) if extents differ.
Measurement measureTemporal(const TemporalPair& pair, bool wantMap);

/// The same after each pixel of the later frame has followed its motion to where its point was, bilinearly: the
/// movement of the camera and of objects is no flicker then. Points that were off the image do not count; nor, with
/// both depths, do those that something hid (a depth that differs by more than 5% from where the point was, at any of
/// the four pixels). A pixel whose motion is not finite counts for nothing. Details: `nonfinite_pixels`, and `covered`,
/// the share of pixels that count.
Measurement measureReprojectedTemporal(const TemporalPair& pair, bool wantMap);

}  // namespace lumi
