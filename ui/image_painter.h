#pragma once
#include <array>
#include <memory>
#include <vector>

#include "gl/program.h"
#include "gl/texture.h"
#include "image/image.h"

namespace lumi {

/// One rectangle of the window with one picture, or two with a wipe.
struct PanePicture {
    Vec2 corner{0}, size{0};  ///< of the rectangle, framebuffer pixels, top-left origin
    int left = 0, right = 0;  ///< which uploaded pictures
    Vec2 origin{0};           ///< of the picture's top-left corner, from `corner`
    float zoom = 1;           ///< framebuffer pixels for each of the picture's
    float wipeX = 1e9f;       ///< from `corner`: `right` is shown from there on
    float grid = 0;           ///< opacity of lines between the picture's pixels
};

/// Puts finished pictures (RGBA8) on the screen. A picture is uploaded when it is another one than before.
class ImagePainter {
public:
    static constexpr int kPictures = 2;

    explicit ImagePainter(const GlFunctions& gl);
    ~ImagePainter();
    ImagePainter(const ImagePainter&) = delete;
    ImagePainter& operator=(const ImagePainter&) = delete;

    void setPicture(int index, std::shared_ptr<const Image8> picture);
    /// Draws into the framebuffer that is bound, of `target` pixels.
    void draw(const std::vector<PanePicture>& panes, Extent2 target, const Vec4& surround);

private:
    const GlFunctions& gl_;
    Program program_;
    GLuint vertexArray_ = 0;
    std::array<std::unique_ptr<GlTexture>, kPictures> textures_;
    std::array<std::shared_ptr<const Image8>, kPictures> uploaded_;
};

}  // namespace lumi
