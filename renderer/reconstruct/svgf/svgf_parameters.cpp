#include "reconstruct/svgf/svgf.h"

namespace lumi {

void SvgfModule::describe(ParameterVisitor& v) {
    parameters_.temporal.describe(v);
    v.choice(
        "variance", parameters_.varianceSource,
        {.label = "Variance from",
         .options = {"spatiotemporal", "spatial"},
         .help = "Where the variance comes from: integrated moments, with the neighbourhood while history is short "
                 "(sec. 4.2), or the neighbourhood alone (fig. 9)"});
    v.when(parameters_.varianceSource == VarianceSource::Spatiotemporal, [&] {
        v.integer("spatial-variance-frames", parameters_.spatialVarianceFrames,
                  {.label = "Spatial variance until",
                   .min = 0,
                   .max = 16,
                   .unit = "frames",
                   .help = "Shorter histories take their variance from a 7x7 neighbourhood (sec. 4.2)"});
    });
    v.integer("levels", parameters_.levels,
              {.label = "Wavelet levels",
               .min = 0,
               .max = kMaxLevels,
               .help = "Iterations of the à-trous transform (sec. 4.3)"});
    v.integer(
        "feedback-level", parameters_.feedbackLevel,
        {.label = "Feedback level",
         .min = 0,
         .max = kMaxLevels,
         .help =
             "The level whose output is the next frame's colour history (sec. 4.3); 0 is the integrated colour, and "
             "the last level is taken where there are fewer"});
    v.number("sigma-depth", parameters_.atrous.edges.sigmaDepth,
             {.label = "Sigma depth",
              .min = 0.01,
              .max = 100,
              .scale = Scale::Log,
              .help = "sigma_z of the depth weight (eq. 3)"});
    v.choice(
        "depth-weight", parameters_.depthWeight,
        {.label = "Depth weight",
         .options = {"as-printed", "plane-distance"},
         .help = "Numerator of eq. 3: the difference in 1/depth as printed, or the distance from the pixel's plane"});
    v.number("sigma-normal", parameters_.atrous.edges.sigmaNormal,
             {.label = "Sigma normal",
              .min = 1,
              .max = 1024,
              .scale = Scale::Log,
              .help = "sigma_n, the normals' exponent (eq. 4)"});
    v.number("sigma-luminance", parameters_.atrous.edges.sigmaLuminance,
             {.label = "Sigma luminance",
              .min = 0.01,
              .max = 100,
              .scale = Scale::Log,
              .help = "sigma_l, in standard deviations of a sample's luminance (eq. 5)"});
    v.toggle("variance-prefilter", parameters_.atrous.variancePrefilter,
             {.label = "Variance prefilter",
              .help = "Blur the variance by a 3x3 Gaussian before it steers the filter (eq. 5, fig. 5)"});
    describeAntialiasing(v);
}

}  // namespace lumi
