#include "measure/metrics.h"

#include "base/error.h"

namespace lumi {

const std::vector<Metric>& metricCatalog() {
    static const std::vector<Metric> catalog = {
        {"rmse", "RMSE", "Root of the mean squared difference of the tone-mapped sRGB images in [0,1], over pixels and channels.", false, true, "magma", measureRmse},
        {"relmse", "relMSE", "Mean over pixels of the squared linear difference summed over channels, divided by the squared gray reference (mean of its channels) + 0.001.", false, false, "magma", measureRelMse},
        {"mse", "MSE", "Mean squared difference of the linear images, over pixels and channels.", false, true, "magma", measureMse},
        {"mae", "MAE", "Mean absolute difference of the linear images, over pixels and channels.", false, true, "magma", measureMae},
        {"psnr", "PSNR", "-10 log10 of the mean squared difference of the tone-mapped sRGB images in [0,1]; dB.", true, true, "magma", measurePsnr},
        {"smape", "SMAPE", "Mean of 2|a-b| / (|a|+|b|+0.01) of the linear images, over pixels and channels.", false, true, "magma", measureSmape},
        {"ssim", "SSIM", "Structural similarity of the tone-mapped sRGB images [Wang 2004]: 11x11 Gaussian window, sigma 1.5, windows fully inside, mean over channels.", true, true, "magma", measureSsim},
        {"ms_ssim", "MS-SSIM", "Multi-scale structural similarity [Wang 2003] with five scales, mean over channels.", true, true, "magma", measureMsSsim},
        {"flip", "LDR-FLIP", "Mean perceived difference when alternating the tone-mapped images [Andersson 2020], 67.0206 pixels per degree.", false, true, "magma", measureFlip},
        {"hdr_flip", "HDR-FLIP", "Mean over pixels of the largest LDR-FLIP over the reference's exposure range [Andersson 2021], ACES, 67.0206 pixels per degree.", false, false, "magma", measureHdrFlip},
        {"cpbd", "CPBD", "Sharpness of the image alone [Narvekar 2011]: share of vertical edges whose blur is not noticed. Noise counts as sharpness; read it beside an error.", true, false, "magma", measureCpbd},
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
    const std::string near = nearestName(id, ids);
    throwUsage({"unknown metric \"" + id + '"', where, near.empty() ? "one of " + all : '"' + near + '"', ""});
}

}  // namespace lumi
