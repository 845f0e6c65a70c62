#include "measure/metrics.h"

#include "base/error.h"
#include "measure/temporal.h"

namespace lumi {

const std::vector<Metric>& metricCatalog() {
    static const std::vector<Metric> catalog = {
        {"rmse", "RMSE",
         "Root of the mean squared difference of the tone-mapped sRGB images in [0,1], over pixels and channels.",
         false, true, "magma", false, measureRmse, "[0, 1]", "usual definition"},
        {"relmse", "relMSE",
         "Mean over pixels of the squared linear difference summed over channels, divided by the squared gray "
         "reference (mean of its channels) + epsilon (0.001).",
         false, false, "magma", false, measureRelMse, "[0, inf)", "Rousselle11"},
        {"mse", "MSE", "Mean squared difference of the linear images, over pixels and channels.", false, true, "magma",
         false, measureMse, "[0, inf)", "usual definition"},
        {"mae", "MAE", "Mean absolute difference of the linear images, over pixels and channels.", false, true, "magma",
         false, measureMae, "[0, inf)", "usual definition"},
        {"psnr", "PSNR", "-10 log10 of the mean squared difference of the tone-mapped sRGB images in [0,1]; dB.", true,
         true, "magma", false, measurePsnr, "[0, inf]", "usual definition"},
        {"smape", "SMAPE", "Mean of 2|a-b| / (|a|+|b|+0.01) of the linear images, over pixels and channels.", false,
         true, "magma", false, measureSmape, "[0, 2)", "usual definition"},
        {"ssim", "SSIM",
         "Structural similarity of the tone-mapped sRGB images [Wang04]: 11x11 Gaussian window, sigma 1.5, windows "
         "fully inside, mean over channels.",
         true, true, "magma", true, measureSsim, "[-1, 1]", "Wang04"},
        {"ms_ssim", "MS-SSIM",
         "Multi-scale structural similarity of the tone-mapped sRGB images [Wang03] with five scales, fewer where a "
         "side is below 161 pixels, mean over channels.",
         true, true, "magma", true, measureMsSsim, "[0, 1]", "Wang03"},
        {"flip", "LDR-FLIP",
         "Mean perceived difference when alternating the tone-mapped images [Andersson20], 67.0206 pixels per degree.",
         false, true, "magma", true, measureFlip, "[0, 1]", "Andersson20"},
        {"hdr_flip", "HDR-FLIP",
         "Mean over pixels of the largest LDR-FLIP over the reference's exposure range [Andersson21], ACES, 67.0206 "
         "pixels per degree.",
         false, false, "magma", true, measureHdrFlip, "[0, 1]", "Andersson21"},
        {"cpbd", "CPBD",
         "Sharpness of the tone-mapped image alone [Narvekar11]: share of vertical edges whose blur is not noticed. "
         "Noise counts as sharpness; read it beside an error.",
         true, false, "magma", true, measureCpbd, "[0, 1]", "Narvekar11"},
    };
    return catalog;
}

const std::vector<SequenceMetric>& sequenceMetricCatalog() {
    static const std::vector<SequenceMetric> catalog = {
        {"temporal", "Temporal error",
         "Mean absolute difference of the luminances of consecutive tone-mapped frames in [0,1]; for static views.",
         false, "[0, 1]", "usual definition"},
        {"temporal_reprojected", "Reprojected temporal error",
         "The same after following the reference's motion, over the points that the frame before saw: what moves is no "
         "flicker.",
         false, "[0, 1]", "this program"},
        {"lag", "Lag",
         "Frames after a step of the light until the output's response to it, in linear luminance, is 0.9.", false,
         "0, 1, 2, ...", "this program"},
    };
    return catalog;
}

const Metric& findMetric(const std::string& id, const std::string& where) {
    std::vector<std::string> ids;
    std::string all;
    for (const Metric& metric : metricCatalog()) {
        if (id == metric.id) return metric;
        ids.push_back(metric.id);
        all += (all.empty() ? "" : ", ") + ids.back();
    }
    for (const SequenceMetric& metric : sequenceMetricCatalog()) ids.push_back(metric.id);
    const std::string near = nearestName(id, ids);
    throwUsage({"unknown metric \"" + id + '"', where, near.empty() ? "one of " + all : '"' + near + '"', ""});
}

}  // namespace lumi
