#pragma once
#include <stop_token>

#include "frame/signals.h"
#include "params/parameter.h"
#include "scene/posed_scene.h"

namespace lumi {

/// Temporal antialiasing after [Karis14], with variance clipping [Salvi16] in YCoCg: the history is fetched along the
/// motion of the nearest surface in 3x3, through a Catmull-Rom filter, and clipped to mean +- gamma standard deviations
/// of the 3x3 neighbourhood; then an exponential average. All of it works on exposed colours compressed by
/// c / (1 + luma), so that a bright sample does not outshine its neighbours; what comes out is scene-linear again.
///
/// Differs from the talk: the history's box comes from the moments in place of minimum and maximum; the jittered sample
/// is not weighted by its distance from the pixel's centre, the average over frames is the pixel's box filter.
struct TaaSettings {
    enum class History { Bilinear, CatmullRom };

    float alpha = 0.1f;
    float gamma = 1.0f;
    bool clip = true;
    History history = History::CatmullRom;

    void describe(ParameterVisitor& v);
};

/// Along what the history is fetched: planes X and Y of `motion` in pixels (previous minus current), at that of a
/// pixel's 3x3 where `nearness` is greatest. That is 1/depth; methods whose motion is that of samples take the square
/// of its length.
struct TaaMotion {
    const Image& motion;
    const Image& nearness;
};

/// What antialiasTemporally() reads.
inline SignalSet taaSignals() { return {Signal::Motion, Signal::InverseDepth}; }

/// The factor that the scene's own exposure stands for, whatever a view shows it at: what is bright is so on the
/// screen, not in the units of the scene.
float exposureFactor(const PosedScene& scene);

/// `colour` (RGB, scene-linear; `exposure` is the factor that brings it to the screen's range) with `previous` (the
/// last frame's `next`, or null) into `next` (compressed, what the next frame needs) and `out` (scene-linear; may be
/// `colour`). What is not finite counts as 0 and does not reach a neighbour's history. `scratch` is any image. Returns
/// false if stopped; outputs are then undefined.
bool antialiasTemporally(const TaaMotion& motion, const TaaSettings& settings, float exposure, const Image& colour,
                         const Image* previous, Image& scratch, Image& next, Image& out, std::stop_token stop);
inline bool antialiasTemporally(const Signals& signals, const TaaSettings& settings, float exposure,
                                const Image& colour, const Image* previous, Image& scratch, Image& next, Image& out,
                                std::stop_token stop) {
    return antialiasTemporally({signals[Signal::Motion], signals[Signal::InverseDepth]}, settings, exposure, colour,
                               previous, scratch, next, out, stop);
}

}  // namespace lumi
