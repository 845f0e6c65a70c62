#include "session/reference_pictures.h"

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <thread>

namespace lumi::test {
namespace {

void waitFor(const char* what, const std::function<bool()>& until) {
    for (int i = 0; i < 5000 && !until(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    ASSERT_TRUE(until()) << what;
}

Image8 converted(const Image& image, const DisplaySettings& display) {
    Image8 pixels;
    convert(image, "RGB", "none", display, pixels);
    return pixels;
}

class ReferencePicturesTest : public testing::Test {
protected:
    ReferencePicturesTest() {
        auto ramp = std::make_shared<Image>(Extent2{16, 4}, 3);
        for (size_t i = 0; i < ramp->size(); ++i) ramp->data()[i] = 0.01f * static_cast<float>(i);
        image = ramp;
    }
    std::shared_ptr<const Image> image;
    ReferencePictures pictures;
    std::array<DisplaySettings, kViewCount> displays;
};

// The same light must look the same beside an image that is shown brighter, by another curve or as one channel.
TEST_F(ReferencePicturesTest, EachViewShowsTheReferenceByItsOwnDisplay) {
    displays[0].exposureEv = 1.5f;
    displays[1].curve = ToneCurve::Reinhard;
    displays[1].channel = 1;
    pictures.show({image, {}}, displays);
    waitFor("the pictures", [&] { return pictures.picture(1) != nullptr; });
    EXPECT_EQ(pictures.picture(0)->rgba, converted(*image, displays[0]).rgba);
    EXPECT_EQ(pictures.picture(1)->rgba, converted(*image, displays[1]).rgba);
    EXPECT_NE(pictures.picture(0)->rgba, pictures.picture(1)->rgba);

    displays[0].exposureEv = -2;
    const uint64_t before = pictures.serial();
    pictures.show({image, {}}, displays);
    EXPECT_NE(pictures.picture(0), nullptr) << "the one before stays meanwhile";
    waitFor("another exposure", [&] { return pictures.serial() > before; });
    EXPECT_EQ(pictures.picture(0)->rgba, converted(*image, displays[0]).rgba);
}

TEST_F(ReferencePicturesTest, APictureFileKeepsTheCurveAndExposureThatAreInIt) {
    displays[0].exposureEv = displays[1].exposureEv = 0.75f;
    displays[1].exposureEv += 1;
    pictures.show({image, 0.75f}, displays);
    waitFor("the pictures", [&] { return pictures.picture(1) != nullptr; });
    DisplaySettings asStored;
    asStored.curve = ToneCurve::Clamp;
    EXPECT_EQ(pictures.picture(0)->rgba, converted(*image, asStored).rgba);
    asStored.exposureEv = 1;
    EXPECT_EQ(pictures.picture(1)->rgba, converted(*image, asStored).rgba) << "a stop brighter than it was stored";
}

TEST_F(ReferencePicturesTest, NothingShownIsNoPicture) {
    EXPECT_EQ(pictures.picture(0), nullptr);
    pictures.show({image, {}}, displays);
    waitFor("the pictures", [&] { return pictures.picture(0) != nullptr; });
    pictures.show({}, displays);
    EXPECT_EQ(pictures.picture(0), nullptr);
}

}  // namespace
}  // namespace lumi::test
