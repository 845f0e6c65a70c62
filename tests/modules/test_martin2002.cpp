// One sample a pixel that follows its surface, and the box filter over time [Martin02].
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "reconstruct/martin2002/martin2002.h"
#include "reconstruct/supersampling/supersampling.h"
#include "support/stable_rig.h"

namespace lumi::test {
namespace {

TEST(Martin2002, AveragesThreeFrames) {
    const Extent2 extent{30, 20};
    Rig rig(extent);
    Martin2002Module module;
    module.resize(extent);
    const auto posed = balls().pose();
    std::vector<Image> single;
    for (int frame = 0; frame < 5; ++frame) {
        const Image image = rig.run(module, frame, posed, view(0.1f * static_cast<float>(frame)), {.camera = true});
        single.push_back(module.tap("unfiltered"));
        const int count = std::min(frame + 1, 3);
        for (size_t i = 0; i < image.size(); ++i) {
            float mean = 0;
            for (int k = 0; k < count; ++k) mean += single[static_cast<size_t>(frame - k)].data()[i];
            ASSERT_NEAR(image.data()[i], mean / static_cast<float>(count), 1e-5f) << frame;
        }
    }
}

// Of the samples that land in a pixel the closest stays; pixels that none lands in get one through their middle.
TEST(Martin2002, KeepsOneSampleAPixel) {
    const Extent2 extent{60, 40};
    Rig rig(extent);
    Martin2002Module module;
    module.resize(extent);
    const auto posed = balls().pose();
    rig.run(module, 0, posed, view(), {});
    for (size_t p = 0; p < 2400; ++p) ASSERT_EQ(module.tap("verdicts").data()[p], 0);
    rig.run(module, 1, posed, view(0.07f), {.camera = true});
    int counts[3] = {};
    for (size_t p = 0; p < 2400; ++p) ++counts[static_cast<int>(module.tap("verdicts").data()[p])];
    EXPECT_GT(counts[0], 10);
    EXPECT_GT(counts[1], 1500);
}

/// Black balls before a sky: what a sample shows never changes.
TinyScene silhouettes() {
    TinyScene tiny;
    for (int i = 0; i < 5; ++i)
        tiny.add(sphereMesh(0.4f, 24, 12), lambert(0), translation(Vec3(static_cast<float>(i) - 2, 0.4f, 0)));
    tiny.scene.environment.constant = Vec3(0.2f);
    return tiny;
}

// A filter along the samples leaves alone what does not change along their way, where one on the screen blurs it.
TEST(Martin2002, AveragesAlongSamplesOrOnTheScreen) {
    const Extent2 extent{60, 40};
    const auto posed = silhouettes().pose();
    for (const bool onScene : {true, false}) {
        Rig rig(extent);
        Martin2002Module module;
        module.resize(extent);
        set(module, "average", std::string(onScene ? "scene" : "screen"));
        int blurred = 0;
        for (int frame = 0; frame < 4; ++frame) {
            const Image image =
                rig.run(module, frame, posed, view(0.08f * static_cast<float>(frame)), {.camera = true});
            for (size_t i = 0; i < image.size(); ++i)
                blurred += std::fabs(image.data()[i] - module.tap("unfiltered").data()[i]) > 1e-6f;
        }
        if (onScene) EXPECT_EQ(blurred, 0);
        else EXPECT_GT(blurred, 100);
    }
}

// With the Gaussian the method makes its image as the others do: its first samples are those of supersampling.
TEST(Martin2002, ReconstructsAsSupersamplingDoes) {
    const Extent2 extent{60, 40};
    const auto posed = silhouettes().pose();
    Rig rig(extent), other(extent);
    Martin2002Module module;
    SupersamplingModule supersampling;
    module.resize(extent), supersampling.resize(extent);
    set(module, "filter", std::string("gaussian"));
    const Image image = rig.run(module, 0, posed, view(), {}),
                expected = other.run(supersampling, 0, posed, view(), {});
    for (size_t i = 0; i < image.size(); ++i) ASSERT_NEAR(image.data()[i], expected.data()[i], 1e-6f);
}

}  // namespace
}  // namespace lumi::test
