#pragma once
#include "frame/signals.h"

namespace lumi {

/// The lighting of one frame as SVGF and its relatives filter it [Schied17, sec. 3]: untextured direct and indirect
/// illumination, each divided by the first surface's albedo, and what passes around the filter.
///
/// The albedo is the sum of the lobes' directional albedos, which is what the paper's "per-layer albedos, weighted by
/// their sampling probability" comes to when lobes are chosen in proportion to theirs; a channel of a lobe that the
/// signals store undivided (frame/signals.h: below 0.01, albedo 1) does not count. It is at least 0.01, so that no
/// division blows up.
struct DemodulatedFrame {
    Image emission;  ///< RGB; light that reaches the camera unscattered, emitters and sky
    Image albedo;    ///< RGB in [0.01, 1]; 0.01 on the sky, which has no light to divide
    Image direct;    ///< RGB, demodulated, within 1e15 of 0
    Image indirect;  ///< RGB, demodulated, within 1e15 of 0
    Image dropped;   ///< Y, 1 where a value of the input was not finite
    int64_t droppedPixels = 0;

    /// direct + indirect.
    void addComponents(Image& sum) const;
    size_t bytes() const;
};

/// What demodulate() reads.
inline SignalSet demodulationSignals() {
    return {Signal::Emission, Signal::Albedo, Signal::SpecularAlbedo, Signal::Direct, Signal::Indirect};
}

/// Replaces NaN and infinity by 0, in the emission, which no filter mends, by the neighbours' mean (3x3, those without
/// any), and counts them; what comes out is finite everywhere, and the two components are at
/// most 1e15, whose square is a number, too.
void demodulate(const Signals& signals, DemodulatedFrame& frame);

/// Where a component of a pixel was dropped, and nothing is known of it from before, its neighbours tell best: the mean
/// of those of 3x3 that see a surface and were not dropped, or 0 if there are none. Does nothing where nothing was
/// dropped.
void fillDropped(const Signals& signals, DemodulatedFrame& frame);

/// out = emission + albedo * (direct + indirect); `indirect` may be null. `out` is RGB of the frame's extent.
void remodulate(const DemodulatedFrame& frame, const Image& direct, const Image* indirect, Image& out);

}  // namespace lumi
