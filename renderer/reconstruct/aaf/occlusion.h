#pragma once
#include "reconstruct/aaf/emitters.h"
#include "reconstruct/module.h"

namespace lumi {

/// What the light samples of a frame met, a pixel: R: d1/d2 - 1 of the blocked ones, d1 being the light's distance from
/// the surface and d2 from the blocker (for infinite lights the blocker's distance in metres), G: 1 where blocked, B:
/// the standard deviation of the light (metres; for infinite lights an angle).
///
/// It sends the frame's own shadow rays, with the same random numbers, once more and asks what they hit; where the
/// frame samples no lights (`path.strategy` bsdf), those of light sampling. What a light's own body blocks is not
/// counted, nor a light that was sampled once: nothing tells its size. Returns false if stopped.
bool measureOcclusion(const FrameContext& context, Emitters& emitters, Image& out);

/// Of the blocked pixels of the window of `radius` that see a surface alike, the one with the sharpest shadow, that of
/// the least R B: its R, 1 in G, and in B that product, the shadow's half-width in metres. Among several lights the
/// small and near one counts. 0 in all three where nothing is blocked. `in` as above.
void gatherOcclusion(const Signals& signals, int radius, const Image& in, Image& out);

/// Their normals are within 26 degrees of each other.
bool facesAlike(const Image& normal, Pixel p, Pixel q);

inline SignalSet occlusionSignals() {
    return {Signal::Surface, Signal::ObjectId, Signal::Position, Signal::Normal, Signal::InverseDepth};
}

}  // namespace lumi
