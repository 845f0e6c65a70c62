#include "ui/draw_renderer.h"

#include <imgui.h>

#include <algorithm>
#include <cstddef>

#include "ui/shader_sources.h"

namespace lumi {

DrawRenderer::DrawRenderer(const GlFunctions& gl) : gl_(gl), program_(gl, "ui", kUiVertexShader, kUiFragmentShader) {
    gl.GenVertexArrays(1, &vertexArray_);
    gl.GenBuffers(1, &vertices_);
    gl.GenBuffers(1, &indices_);
    gl.BindVertexArray(vertexArray_);
    gl.BindBuffer(GL_ARRAY_BUFFER, vertices_);
    gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_);
    const auto attribute = [&](GLuint slot, GLint size, GLenum type, GLboolean normalized, size_t offset) {
        gl.EnableVertexAttribArray(slot);
        gl.VertexAttribPointer(slot, size, type, normalized, sizeof(ImDrawVert), reinterpret_cast<const void*>(offset));
    };
    attribute(0, 2, GL_FLOAT, GL_FALSE, offsetof(ImDrawVert, pos));
    attribute(1, 2, GL_FLOAT, GL_FALSE, offsetof(ImDrawVert, uv));
    attribute(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(ImDrawVert, col));
    gl.BindVertexArray(0);
}

DrawRenderer::~DrawRenderer() {
    gl_.DeleteBuffers(1, &vertices_);
    gl_.DeleteBuffers(1, &indices_);
    gl_.DeleteVertexArrays(1, &vertexArray_);
}

void DrawRenderer::uploadFonts() {
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    atlas.GetTexDataAsRGBA32(&pixels, &width, &height);
    fonts_ = std::make_unique<GlTexture>(gl_, GlFilter::Linear);
    fonts_->upload({width, height}, pixels);
    atlas.SetTexID(reinterpret_cast<ImTextureID>(static_cast<intptr_t>(fonts_->id())));
    atlas.ClearTexData();
}

void DrawRenderer::setState(const ImDrawData& data, Extent2 target) {
    gl_.Viewport(0, 0, target.width, target.height);
    gl_.Enable(GL_BLEND);
    gl_.BlendEquation(GL_FUNC_ADD);
    gl_.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    gl_.Disable(GL_CULL_FACE);
    gl_.Disable(GL_DEPTH_TEST);
    gl_.Disable(GL_STENCIL_TEST);
    gl_.Enable(GL_SCISSOR_TEST);
    program_.use();
    program_.set("uTexture", 0);
    program_.set("uPixelScale", 2 / data.DisplaySize.x, 2 / data.DisplaySize.y);
    gl_.ActiveTexture(GL_TEXTURE0);
    gl_.BindVertexArray(vertexArray_);
    gl_.BindBuffer(GL_ARRAY_BUFFER, vertices_);
}

void DrawRenderer::drawList(const ImDrawList& list, const ImDrawData& data, Extent2 target) {
    gl_.BufferData(GL_ARRAY_BUFFER, list.VtxBuffer.size_in_bytes(), list.VtxBuffer.Data, GL_STREAM_DRAW);
    gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER, list.IdxBuffer.size_in_bytes(), list.IdxBuffer.Data, GL_STREAM_DRAW);
    const GLenum indexType = sizeof(ImDrawIdx) == 2 ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT;
    for (const ImDrawCmd& command : list.CmdBuffer) {
        if (command.UserCallback) {
            if (command.UserCallback != ImDrawCallback_ResetRenderState) command.UserCallback(&list, &command);
            setState(data, target);
            continue;
        }
        const ImVec4 clip = command.ClipRect;
        const int left = std::max(0, static_cast<int>(clip.x)), top = std::max(0, static_cast<int>(clip.y));
        const int right = std::min(target.width, static_cast<int>(clip.z));
        const int bottom = std::min(target.height, static_cast<int>(clip.w));
        if (right <= left || bottom <= top) continue;
        gl_.Scissor(left, target.height - bottom, right - left, bottom - top);
        gl_.BindTexture(GL_TEXTURE_2D, static_cast<GLuint>(reinterpret_cast<intptr_t>(command.GetTexID())));
        gl_.DrawElementsBaseVertex(GL_TRIANGLES, static_cast<GLsizei>(command.ElemCount), indexType,
                                   reinterpret_cast<const void*>(command.IdxOffset * sizeof(ImDrawIdx)),
                                   static_cast<GLint>(command.VtxOffset));
    }
}

void DrawRenderer::draw(const ImDrawData& data, Extent2 target) {
    if (target.empty() || data.DisplaySize.x <= 0 || data.DisplaySize.y <= 0) return;
    setState(data, target);
    for (int i = 0; i < data.CmdListsCount; ++i) drawList(*data.CmdLists[i], data, target);
    gl_.BindVertexArray(0);
    gl_.Disable(GL_SCISSOR_TEST);
    gl_.Disable(GL_BLEND);
}

}  // namespace lumi
