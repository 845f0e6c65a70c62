#include "trace/eye_media.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace lumi {
namespace {

MediumStack inside(uint32_t material) {
    MediumStack media;
    media.enter(material);
    return media;
}

TEST(EyeMedia, FollowsEachChange) {
    const std::pair<float, uint32_t> changes[] = {{0.3f, 1}, {0.3f + 1.0f / 64, 2}, {0.71f, 1}, {0.95f, 3}};
    const auto truth = [&](float time) {
        MediumStack media;
        for (const auto& [from, material] : changes)
            if (time >= from) media = inside(material);
        return media;
    };
    int asked = 0;
    const EyeMedia media(0, 1, [&](float time) { return ++asked, truth(time); });
    for (int i = 0; i <= 5000; ++i) {
        const float time = static_cast<float>(i) / 5000;
        const bool isNear = std::ranges::any_of(
            changes, [&](const auto& change) { return std::abs(time - change.first) < 1.0f / 4000; });
        EXPECT_TRUE(isNear || media.at(time) == truth(time)) << time;
    }
    EXPECT_LT(asked, 80);
    EXPECT_TRUE(media.isAnywhere());
}

TEST(EyeMedia, AnInstantIsAskedOnce) {
    int asked = 0;
    const EyeMedia media(0.25f, 0.25f, [&](float time) {
        EXPECT_EQ(time, 0.25f);
        return ++asked, inside(4);
    });
    EXPECT_EQ(asked, 1);
    for (const float time : {0.0f, 0.25f, 1.0f}) EXPECT_EQ(media.at(time), inside(4));
    EXPECT_FALSE(EyeMedia().isAnywhere());
    EXPECT_EQ(EyeMedia().at(0.5f), MediumStack());
}

TEST(EyeMedia, ChangesWithoutEndComeToAnEnd) {
    uint32_t asked = 0;
    const EyeMedia media(0, 1, [&](float) { return inside(asked++); });
    EXPECT_LT(asked, 200000u);
    EXPECT_TRUE(media.isAnywhere());
}

}  // namespace
}  // namespace lumi
