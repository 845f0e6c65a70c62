#pragma once
#include <span>
#include <stop_token>

#include "image/image.h"
#include "params/parameter.h"

namespace lumi {

/// Reconstruction of an image from samples at any place, any number of them a pixel [DalCorso17, sec. 4.4]: a Gaussian
/// around each pixel's centre over the samples in its 3 x 3 pixels, divided by the sum of its weights.
struct ScatteredSettings {
    enum class Filter { Gaussian, Box };

    Filter filter = Filter::Gaussian;
    float sigma = 0.7f;  ///< pixels; of the paper's sharpness, see reconstruct/stable/stable.h
    /// filter colours compressed by c / (1 + luminance), so that a bright sample does not outshine its neighbours
    bool toneMapped = true;

    /// `onePerPixel`: each pixel has one sample, and a box leaves it as it is, tone-mapped or not.
    void describe(ParameterVisitor& v, bool onePerPixel = false);
};

/// Samples of an image: those of pixel p are [first[p], first[p + 1]), and lie within it.
struct ScatteredSamples {
    Extent2 extent;
    std::span<const uint32_t> first;
    std::span<const Vec2> places;
    std::span<const Vec3> colours;    ///< scene-linear; what is not finite counts as hidden
    std::span<const uint8_t> hidden;  ///< 1: plays no part; may be empty
};

/// Weight of a sample in the pixel whose centre is `off` away, if that is among its 3 x 3 (Gaussian) or its own (box);
/// 0 where the colour is not finite. With `toneMapped` a sample weighs 1 / (1 + luminance) as much: that is what
/// compressing colours before the filter and expanding their mean comes to.
float scatteredWeight(const ScatteredSettings& settings, Vec2 off, const Vec3& colour);

/// The image, RGB, scene-linear, and the sum of weights of each pixel (Y). Where that is 0, no sample was near: the
/// pixel gets the mean of those of its eight neighbours that have a colour, round after round; without any sample all
/// is black. Sums below 1e-30 count as 0. Returns the number of such pixels; -1 if stopped.
int64_t reconstructScattered(const ScatteredSamples& samples, const ScatteredSettings& settings, Image& out,
                             Image& weights, std::stop_token stop);

}  // namespace lumi
