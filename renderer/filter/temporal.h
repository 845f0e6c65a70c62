#pragma once
#include <stop_token>
#include <vector>

#include "filter/reprojection.h"

namespace lumi {

/// The temporal filter of SVGF [Schied17, sec. 4.1 and 4.2]: exponential moving averages of colour and of the luminance
/// moments along motion vectors, reset where no tap of the previous frame saw the same surface.
///
/// Differs from the paper: the second moment is kept about the mean, which float holds more digits of; sigma'^2 is the
/// same number as mu2' - mu1'^2.
struct TemporalSettings {
    float colourAlpha = 0.2f;
    float momentsAlpha = 0.2f;
    bool arithmeticWarmUp = false;  ///< 1/n until that falls below alpha
    bool moments = true;            ///< the method uses them: they are kept, and their alpha is a parameter of it
    ReprojectionSettings reprojection;

    void describe(ParameterVisitor& v);
};

/// One component (direct, indirect or both together) as it is carried from frame to frame.
struct TemporalComponent {
    Image colour;          ///< RGB, integrated, or what a spatial filter feeds back in its place
    Image mean;            ///< first moment of luminance; empty, like the next, where nobody uses moments
    Image sampleVariance;  ///< sigma'^2 = mu2' - mu1'^2, the variance of one sample
};

struct TemporalHistory {
    std::vector<TemporalComponent> components;
    Image length;  ///< frames that make up a pixel, 1 after a disocclusion; 0 on the sky
    SurfaceRecord surface;

    void reset(Extent2 extent, int components, bool moments);
    size_t bytes() const;
};

using HistoryLoss = std::vector<const Image*>;

/// What the temporal filter may be given, or asked for, beside its settings; images are Y planes of the frame's extent.
struct TemporalOptions {
    /// How much of the history to give up, lambda from 0 (none) to 1 (all): one a component, or none. The new sample's
    /// weight is alpha + (1 - alpha) lambda, and the history's length shrinks by the largest lambda of the components.
    HistoryLoss loss{};
    /// Where the luminance of the integrated colours goes: one a component, or none.
    std::vector<Image*> luminance{};
    /// Not 0 where the sample is no measurement, as it was not finite: with a history it counts nothing, and the
    /// history does not grow. Null: there are none.
    const Image* dropped = nullptr;
    VerdictImages verdicts{};
};

/// Integrates `samples` (RGB, finite, one a component) with `previous` (null: no history) into `next`. Returns false if
/// stopped; `next` is then undefined.
bool filterTemporally(const Signals& signals, const TemporalSettings& settings,
                      const std::vector<const Image*>& samples, const TemporalHistory* previous, TemporalHistory& next,
                      std::stop_token stop, const TemporalOptions& options = {});

}  // namespace lumi
