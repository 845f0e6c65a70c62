#include "ui/image_painter.h"

#include "ui/shader_sources.h"

namespace lumi {

ImagePainter::ImagePainter(const GlFunctions& gl)
    : gl_(gl), program_(gl, "view", kViewVertexShader, kViewFragmentShader) {
    gl.GenVertexArrays(1, &vertexArray_);
    for (auto& texture : textures_) texture = std::make_unique<GlTexture>(gl, GlFilter::Nearest);
}

ImagePainter::~ImagePainter() { gl_.DeleteVertexArrays(1, &vertexArray_); }

void ImagePainter::setPicture(int index, std::shared_ptr<const Image8> picture) {
    const auto i = static_cast<size_t>(index);
    if (!picture || picture == uploaded_[i] || picture->extent.empty()) return;
    textures_[i]->upload(picture->extent, picture->rgba.data());
    uploaded_[i] = std::move(picture);  // held, so that the address of the next one cannot be the same
}

void ImagePainter::draw(const std::vector<PanePicture>& panes, Extent2 target, const Vec4& surround) {
    gl_.Disable(GL_BLEND);
    gl_.Enable(GL_SCISSOR_TEST);
    gl_.Viewport(0, 0, target.width, target.height);
    gl_.BindVertexArray(vertexArray_);
    program_.use();
    program_.set("uLeft", 0);
    program_.set("uRight", 1);
    program_.set("uTargetHeight", static_cast<float>(target.height));
    program_.set("uSurround", surround.x, surround.y, surround.z, surround.w);
    for (const PanePicture& pane : panes) {
        if (!uploaded_[static_cast<size_t>(pane.left)] || !uploaded_[static_cast<size_t>(pane.right)]) continue;
        textures_[static_cast<size_t>(pane.left)]->bind(0);
        textures_[static_cast<size_t>(pane.right)]->bind(1);
        program_.set("uViewportCorner", pane.corner.x, pane.corner.y);
        program_.set("uOrigin", pane.origin.x, pane.origin.y);
        program_.set("uZoom", pane.zoom);
        program_.set("uWipe", pane.wipeX);
        program_.set("uGrid", pane.grid);
        gl_.Scissor(static_cast<GLint>(pane.corner.x),
                    target.height - static_cast<GLint>(pane.corner.y) - static_cast<GLint>(pane.size.y),
                    static_cast<GLsizei>(pane.size.x), static_cast<GLsizei>(pane.size.y));
        gl_.DrawArrays(GL_TRIANGLES, 0, 3);
    }
    gl_.BindVertexArray(0);
    gl_.Disable(GL_SCISSOR_TEST);
}

}  // namespace lumi
