#pragma once
#include <algorithm>

#include "math/vector.h"

namespace lumi {

/// How the picture lies in its pane; both panes share it. Sizes are framebuffer pixels.
class ViewTransform {
public:
    static constexpr float kMinZoom = 1.0f / 16, kMaxZoom = 256;

    /// Call each frame before use: while fitting, zoom and centre follow the pane.
    void update(Vec2 pane, Extent2 picture) {
        const Vec2 size(std::max(picture.width, 1), std::max(picture.height, 1));
        if (fit_) {
            zoom_ = std::clamp(std::min(pane.x / size.x, pane.y / size.y), kMinZoom, kMaxZoom);
            centre_ = 0.5f * size;
        }
        centre_ = glm::clamp(centre_, Vec2(0), size);
        pane_ = pane;
    }

    bool fits() const { return fit_; }
    float zoom() const { return zoom_; }
    /// The picture's top-left corner in the pane; whole pixels, so that zooms by whole numbers stay sharp.
    Vec2 origin() const { return glm::round(0.5f * pane_ - centre_ * zoom_); }
    Vec2 pictureFromPane(Vec2 inPane) const { return (inPane - origin()) / zoom_; }
    Vec2 paneFromPicture(Vec2 inPicture) const { return origin() + inPicture * zoom_; }

    void fit() { fit_ = true; }
    void setZoom(float zoom) {
        fit_ = false;
        zoom_ = std::clamp(zoom, kMinZoom, kMaxZoom);
    }
    /// Zooms by `factor` so that what is under `inPane` stays there.
    void zoomAt(Vec2 inPane, float factor) {
        const Vec2 fixed = centre_ + (inPane - 0.5f * pane_) / zoom_;  // not by origin(): its rounding would add up
        setZoom(zoom_ * factor);
        centre_ = fixed - (inPane - 0.5f * pane_) / zoom_;
    }
    void pan(Vec2 deltaPane) {
        fit_ = false;
        centre_ -= deltaPane / zoom_;
    }

private:
    bool fit_ = true;
    float zoom_ = 1;
    Vec2 centre_{0}, pane_{1};
};

}  // namespace lumi
