// What is shown of stable ray tracing's samples.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "reconstruct/stable/stable.h"
#include "support/stable_rig.h"

namespace lumi::test {
namespace {

// What is shown of the samples is what they are.
TEST(Stable, ViewsTellOfTheSamples) {
    const Extent2 extent{48, 32};
    Rig rig(extent);
    StableModule module;
    module.resize(extent);
    set(module, "density", 0.5f);  // so that pixels are empty
    const auto posed = balls().pose();
    int holes[3] = {0, 0, 0};
    for (FrameNumber frame = 0; frame < 6; ++frame) {
        Camera camera = view();
        camera.eye.x += 0.2f * static_cast<float>(frame);
        const Image out = rig.run(module, frame, posed, camera, {.camera = true});
        const SampleSet& samples = module.samples();
        double ages = 0, paths = 0;
        for (int y = 0; y < extent.height; ++y)
            for (int x = 0; x < extent.width; ++x) {
                const auto wordAt = [&](int u, int v) {
                    return samples.words[static_cast<size_t>(v) * 48 + static_cast<size_t>(u)];
                };
                const auto of = [&](const char* tap, int channel = 0) { return module.tap(tap).at(channel, x, y); };
                const uint32_t word = wordAt(x, y);
                ASSERT_EQ(of("occupancy"), static_cast<float>(word & 0xFFFF));
                ASSERT_EQ(of("occlusion"), static_cast<float>(word >> 16));
                ASSERT_EQ(of("sampleCount"), static_cast<float>(std::popcount((word & 0xFFFF) & ~(word >> 16))));
                ASSERT_EQ(of("bitmasks", 2), 0.25f * of("sampleCount"));
                ASSERT_EQ(of("bitmasks", 0), 0.25f * static_cast<float>(std::popcount(word >> 16)));
                int near = 0;
                for (int v = std::max(y - 1, 0); v <= std::min(y + 1, extent.height - 1); ++v)
                    for (int u = std::max(x - 1, 0); u <= std::min(x + 1, extent.width - 1); ++u)
                        near += std::popcount((wordAt(u, v) & 0xFFFF) & ~(wordAt(u, v) >> 16));
                ASSERT_EQ(of("holes"), of("sampleCount") > 0 ? 0 : near > 0 ? 1 : 2) << x << ' ' << y;
                ++holes[static_cast<int>(of("holes"))];
                double age = 0, count = 0, drawn = 0;
                const auto pixel = static_cast<size_t>(y) * 48 + static_cast<size_t>(x);
                for (uint32_t i = samples.first[pixel]; i < samples.first[pixel + 1]; ++i) {
                    if (samples.flags[i] & SampleSet::kOccluded) continue;
                    ++count, age += samples.notes[i].age, drawn += samples.notes[i].indirectCount;
                }
                ASSERT_EQ(count, of("sampleCount"));
                if (count == 0) continue;
                ASSERT_NEAR(of("age"), age / count, 1e-4);
                ASSERT_NEAR(of("indirectCount"), drawn / count, 1e-4);
                const float verdict = of("verdicts");
                ASSERT_TRUE(verdict >= 1 && verdict <= 5 && verdict == std::floor(verdict)) << verdict;
                ASSERT_TRUE(frame > 0 || verdict == 2) << "all are new";
                ages = std::max(ages, age / count), paths = std::max(paths, drawn / count);
            }
        EXPECT_EQ(ages, frame);
        EXPECT_EQ(paths, frame + 1);
    }
    EXPECT_GT(holes[1], 500);
    EXPECT_GT(holes[2], 0);
}

}  // namespace
}  // namespace lumi::test
