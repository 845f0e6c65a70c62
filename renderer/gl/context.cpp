#include "gl/context.h"

#include <fmt/format.h>

#include "base/error.h"

namespace lumi {

void HeadlessContext::finish(const std::string& platform, const GlFunctions::GetProcAddress& getProcAddress) {
    gl_ = std::make_unique<GlFunctions>(getProcAddress);
    GLint major = 0, minor = 0;
    gl_->GetIntegerv(GL_MAJOR_VERSION, &major);
    gl_->GetIntegerv(GL_MINOR_VERSION, &minor);
    const auto* renderer = reinterpret_cast<const char*>(gl_->GetString(GL_RENDERER));
    description_ =
        fmt::format("{}, {}, OpenGL {}.{}", platform, renderer ? renderer : "unknown renderer", major, minor);
}

std::unique_ptr<HeadlessContext> createHeadlessContext(ContextKind kind) {
    return kind == ContextKind::Egl ? createEglContext() : createOsMesaContext();
}

std::unique_ptr<HeadlessContext> createHeadlessContext() {
    std::string eglReason;
    try {
        return createEglContext();
    } catch (const Error& error) {
        eglReason = error.what();
    }
    try {
        return createOsMesaContext();
    } catch (const Error& error) {
        throw Error(ErrorKind::NoDisplay,
                    {.what = fmt::format("no OpenGL without a display ({}; {})", eglReason, error.what()),
                     .where = "",
                     .expected = "the packages libegl1 and libgl1-mesa-dri, or libosmesa6",
                     .found = ""});
    }
}

}  // namespace lumi
