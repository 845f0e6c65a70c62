#include "gl/functions.h"

#include <fmt/format.h>

#include "base/error.h"

namespace lumi {

namespace {

void require33(const GlFunctions& gl) {
    GLint major = 0, minor = 0;
    gl.GetIntegerv(GL_MAJOR_VERSION, &major);
    gl.GetIntegerv(GL_MINOR_VERSION, &minor);
    if (major * 10 + minor < 33)
        throw Error(ErrorKind::NoDisplay, {.what = "the OpenGL driver is too old",
                                           .where = "",
                                           .expected = "OpenGL 3.3 or newer",
                                           .found = fmt::format("{}.{}", major, minor)});
}

}  // namespace

GlFunctions::GlFunctions(const GetProcAddress& getProcAddress) {
#define LUMI_GL_LOAD(name, type)                                                                 \
    name = reinterpret_cast<PFNGL##type##PROC>(getProcAddress("gl" #name));                      \
    if (!name)                                                                                   \
        throw Error(ErrorKind::NoDisplay, {.what = "the OpenGL driver has no function gl" #name, \
                                           .where = "",                                          \
                                           .expected = "OpenGL 3.3 or newer",                    \
                                           .found = ""});
    LUMI_GL_FUNCTIONS(LUMI_GL_LOAD)
#undef LUMI_GL_LOAD
    require33(*this);
}

}  // namespace lumi
