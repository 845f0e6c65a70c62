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
    Image colour;           ///< RGB, integrated, or what a spatial filter feeds back in its place
    Image mean;             ///< first moment of luminance; empty, like the next, where nobody uses moments
    Image sampleVariance;   ///< sigma'^2 = mu2' - mu1'^2, the variance of one sample
};

struct TemporalHistory {
    std::vector<TemporalComponent> components;
    Image length;  ///< frames that make up a pixel, 1 after a disocclusion; 0 on the sky
    SurfaceRecord surface;

    void reset(Extent2 extent, int components, bool moments);
    size_t bytes() const;
};

/// What a row of the temporal filter may be given beside its settings: how much of the history to give up, 0 (none) to 1
/// (all), one plane a component; none, or as many as components.
using HistoryLoss = std::vector<const Image*>;

/// Where the luminance of the integrated colours is wanted beside them: one plane a component, or none.
using IntegratedLuminance = std::vector<Image*>;

/// Integrates `samples` (RGB, finite, one a component) with `previous` (null: no history) into `next`.
/// `verdict`, if given, gets verdictValue() of each pixel. With `loss` lambda the weight of the new sample is
/// alpha + (1 - alpha) lambda, and the history's length shrinks by the largest lambda of the components. Returns false if stopped; `next` is then undefined.
bool filterTemporally(const Signals& signals, const TemporalSettings& settings, const std::vector<const Image*>& samples,
                      const TemporalHistory* previous, TemporalHistory& next, Image* verdict, std::stop_token stop, const HistoryLoss& loss = {},
                      const IntegratedLuminance& luminance = {});

}  // namespace lumi
