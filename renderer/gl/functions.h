#pragma once
#include <GL/glcorearb.h>

#include <functional>

namespace lumi {

// Every OpenGL 3.3 function that we call: name without "gl", name of its pointer type.
// clang-format off
#define LUMI_GL_FUNCTIONS(X) \
    X(ActiveTexture, ACTIVETEXTURE) X(AttachShader, ATTACHSHADER) X(BindBuffer, BINDBUFFER) \
    X(BindFramebuffer, BINDFRAMEBUFFER) X(BindRenderbuffer, BINDRENDERBUFFER) X(BindTexture, BINDTEXTURE) \
    X(BindVertexArray, BINDVERTEXARRAY) X(BlendEquation, BLENDEQUATION) X(BlendFuncSeparate, BLENDFUNCSEPARATE) \
    X(BufferData, BUFFERDATA) X(CheckFramebufferStatus, CHECKFRAMEBUFFERSTATUS) X(Clear, CLEAR) \
    X(ClearColor, CLEARCOLOR) X(CompileShader, COMPILESHADER) X(CreateProgram, CREATEPROGRAM) \
    X(CreateShader, CREATESHADER) X(DeleteBuffers, DELETEBUFFERS) X(DeleteFramebuffers, DELETEFRAMEBUFFERS) \
    X(DeleteProgram, DELETEPROGRAM) X(DeleteShader, DELETESHADER) X(DeleteTextures, DELETETEXTURES) \
    X(DeleteVertexArrays, DELETEVERTEXARRAYS) X(Disable, DISABLE) X(DrawArrays, DRAWARRAYS) \
    X(DrawElementsBaseVertex, DRAWELEMENTSBASEVERTEX) X(Enable, ENABLE) \
    X(EnableVertexAttribArray, ENABLEVERTEXATTRIBARRAY) X(Finish, FINISH) \
    X(FramebufferTexture2D, FRAMEBUFFERTEXTURE2D) X(GenBuffers, GENBUFFERS) X(GenFramebuffers, GENFRAMEBUFFERS) \
    X(GenTextures, GENTEXTURES) X(GenVertexArrays, GENVERTEXARRAYS) X(GetError, GETERROR) \
    X(GetIntegerv, GETINTEGERV) X(GetProgramInfoLog, GETPROGRAMINFOLOG) X(GetProgramiv, GETPROGRAMIV) \
    X(GetShaderInfoLog, GETSHADERINFOLOG) X(GetShaderiv, GETSHADERIV) X(GetString, GETSTRING) \
    X(GetUniformLocation, GETUNIFORMLOCATION) X(LinkProgram, LINKPROGRAM) X(PixelStorei, PIXELSTOREI) \
    X(ReadPixels, READPIXELS) X(Scissor, SCISSOR) X(ShaderSource, SHADERSOURCE) X(TexImage2D, TEXIMAGE2D) \
    X(TexParameteri, TEXPARAMETERI) X(TexSubImage2D, TEXSUBIMAGE2D) X(Uniform1f, UNIFORM1F) \
    X(Uniform1i, UNIFORM1I) X(Uniform2f, UNIFORM2F) X(Uniform4f, UNIFORM4F) X(UseProgram, USEPROGRAM) \
    X(VertexAttribPointer, VERTEXATTRIBPOINTER) X(Viewport, VIEWPORT)
// clang-format on

/// The functions of one context. The program links no gl* symbol: what OSMesa, EGL and GLFW give under one name differ.
struct GlFunctions {
    using GetProcAddress = std::function<void*(const char* name)>;

    /// Throws Error(NoDisplay) if a function is missing or the context is older than OpenGL 3.3. The context is
    /// current.
    explicit GlFunctions(const GetProcAddress& getProcAddress);

#define LUMI_GL_MEMBER(name, type) PFNGL##type##PROC name = nullptr;
    LUMI_GL_FUNCTIONS(LUMI_GL_MEMBER)
#undef LUMI_GL_MEMBER
};

}  // namespace lumi
