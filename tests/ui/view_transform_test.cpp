#include "ui/view_transform.h"

#include <gtest/gtest.h>

namespace lumi {
namespace {

constexpr Extent2 kPicture{640, 360};

TEST(ViewTransform, fitsAndCentres) {
    ViewTransform view;
    view.update({960, 720}, kPicture);
    EXPECT_FLOAT_EQ(view.zoom(), 1.5f);
    EXPECT_EQ(view.origin(), Vec2(0, 90));
}

TEST(ViewTransform, zoomKeepsWhatIsUnderThePointer) {
    ViewTransform view;
    view.update({960, 720}, kPicture);
    const Vec2 pointer(300, 400);
    const Vec2 before = view.pictureFromPane(pointer);
    for (int i = 0; i < 12; ++i) {
        view.zoomAt(pointer, 1.25f);
        view.update({960, 720}, kPicture);
        // The origin is on whole screen pixels: half a one is what may be lost.
        EXPECT_NEAR(view.pictureFromPane(pointer).x, before.x, 0.51f / view.zoom());
        EXPECT_NEAR(view.pictureFromPane(pointer).y, before.y, 0.51f / view.zoom());
    }
    EXPECT_FALSE(view.fits());
}

TEST(ViewTransform, placesGoBothWays) {
    ViewTransform view;
    view.update({501, 333}, kPicture);
    view.setZoom(7);
    view.update({501, 333}, kPicture);
    const Vec2 place(123.25f, 45.5f);
    const Vec2 there = view.pictureFromPane(view.paneFromPicture(place));
    EXPECT_NEAR(there.x, place.x, 1e-3);
    EXPECT_NEAR(there.y, place.y, 1e-3);
}

TEST(ViewTransform, staysInRangeAndOnThePicture) {
    ViewTransform view;
    view.update({960, 720}, kPicture);
    view.zoomAt({0, 0}, 1e9f);
    EXPECT_EQ(view.zoom(), ViewTransform::kMaxZoom);
    view.pan({1e7f, 1e7f});
    view.update({960, 720}, kPicture);
    const Vec2 centre = view.pictureFromPane({480, 360});
    EXPECT_GE(centre.x, -1);
    EXPECT_GE(centre.y, -1);
    view.fit();
    view.update({960, 720}, kPicture);
    EXPECT_FLOAT_EQ(view.zoom(), 1.5f);
}

TEST(ViewTransform, survivesAnEmptyPane) {
    ViewTransform view;
    view.update({0, 0}, {0, 0});
    EXPECT_GT(view.zoom(), 0);
}

}  // namespace
}  // namespace lumi
