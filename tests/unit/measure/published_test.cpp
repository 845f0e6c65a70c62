// Values that others published for given image pairs (see EXPECTED.md beside them).
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "image/hdr.h"
#include "measure/metrics.h"

namespace lumi {
namespace {

std::filesystem::path asset(const std::string& name) {
    const char* folder = std::getenv("LUMISCOPE_ASSETS");
    const std::filesystem::path root = folder ? folder : LUMISCOPE_SOURCE_DIR "/../shared/assets";
    return root / "metrics" / name;
}

#define REQUIRE_ASSET(name) \
    if (!std::filesystem::exists(asset(name))) GTEST_SKIP() << "the test asset " << asset(name) << " is not here"

ImagePair load(const std::string& image, const std::string& reference) {
    ImagePair pair{loadImage(asset(image)), loadImage(asset(reference)), {}, 0};
    pair.prepare();
    return pair;
}

TEST(Published, LdrFlipOfTheTree) {
    REQUIRE_ASSET("flip_tree");
    const ImagePair pair = load("flip_tree/tree-test.png", "flip_tree/tree-ref.png");
    const Measurement flip = measureFlip(pair, true);
    EXPECT_NEAR(flip.value, 0.133276, 1e-5);
    float highest = 0;
    for (size_t i = 0; i < flip.map.size(); ++i) highest = std::max(highest, flip.map.data()[i]);
    EXPECT_NEAR(highest, 0.983034, 1e-4);
}

TEST(Published, HdrFlipOfTheDenoiserPair) {
    REQUIRE_ASSET("hdr_denoiser_pair");
    const ImagePair pair = load("hdr_denoiser_pair/noisy.exr", "hdr_denoiser_pair/ref.exr");
    const Measurement flip = measureHdrFlip(pair, false);
    EXPECT_NEAR(flip.details[0].second, -3.0435, 1e-3);
    EXPECT_NEAR(flip.details[1].second, 5.8919, 1e-3);
    EXPECT_EQ(flip.details[2].second, 9);
    EXPECT_NEAR(flip.value, 0.339822, 5e-5);
    ImagePair fixed = pair;
    fixed.settings.flipExposures = FlipExposures{-3, 3, 5};
    EXPECT_NEAR(measureHdrFlip(fixed, false).value, 0.206899, 5e-5);
}

TEST(Published, PsnrSsimAndFlipOfTheCamera) {
    REQUIRE_ASSET("psnr_ssim_camera");
    const ImagePair pair = load("psnr_ssim_camera/camera_noisy.png", "psnr_ssim_camera/camera.png");
    EXPECT_NEAR(measurePsnr(pair, false).value, 22.409353363576034, 1e-4);
    EXPECT_NEAR(measureSsim(pair, false).value, 0.357959091663361, 1e-3);
    EXPECT_NEAR(measureFlip(pair, false).value, 0.110325, 1e-5);
}

/// Two gray images of one row.
ImagePair grayPair(const std::vector<float>& image, const std::vector<float>& reference) {
    const Extent2 extent{static_cast<int>(image.size()), 1};
    ImagePair pair{Image(extent, 3), Image(extent, 3), {}, 0};
    for (int c = 0; c < 3; ++c)
        for (size_t x = 0; x < image.size(); ++x) {
            pair.image.at(c, static_cast<int>(x), 0) = image[x];
            pair.reference.at(c, static_cast<int>(x), 0) = reference[x];
        }
    pair.prepare();
    return pair;
}

TEST(Published, ErrorsOfShortVectors) {
    // scikit-learn's manual, mean_squared_error and mean_absolute_error.
    const ImagePair pair = grayPair({2.5f, 0, 2, 8}, {3, -0.5f, 2, 7});
    EXPECT_NEAR(measureMse(pair, false).value, 0.375, 1e-6);
    EXPECT_NEAR(measureMae(pair, false).value, 0.5, 1e-6);
    // torchmetrics' manual, SymmetricMeanAbsolutePercentageError; ours has 0.01 in the denominator.
    EXPECT_NEAR(measureSmape(grayPair({0.9f, 15, 1.2e6f}, {1, 10, 1e6f}), false).value, 0.2290, 3e-4);
}

TEST(Published, RmseOfTheCamera) {
    REQUIRE_ASSET("psnr_ssim_camera");
    const ImagePair pair = load("psnr_ssim_camera/camera_noisy.png", "psnr_ssim_camera/camera.png");
    EXPECT_NEAR(measureRmse(pair, false).value, std::pow(10, -22.409353363576034 / 20), 1e-6);
}

TEST(Published, SsimAndMsSsimOfTheCheckerboards) {
    REQUIRE_ASSET("ssim_tf_checkerboard");
    const std::string stem = "ssim_tf_checkerboard/checkerboard";
    const struct {
        int a, b;
        double ssim, msSsim;
    } rows[] = {{1, 2, 0.230880, 0.091016}, {1, 3, 0.231153, 0.091025}, {2, 3, 0.996828, 0.999567}};
    for (const auto& row : rows) {
        const ImagePair pair = load(stem + std::to_string(row.a) + ".png", stem + std::to_string(row.b) + ".png");
        EXPECT_NEAR(measureSsim(pair, false).value, row.ssim, 5e-4) << row.a << row.b;
        EXPECT_NEAR(measureMsSsim(pair, false).value, row.msSsim, 5e-4) << row.a << row.b;
    }
}

}  // namespace
}  // namespace lumi
