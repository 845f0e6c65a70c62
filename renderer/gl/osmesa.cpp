#include <array>

#include "base/error.h"
#include "gl/context.h"
#include "gl/library.h"

namespace lumi {

namespace {

// From GL/osmesa.h, which cannot be included beside glcorearb.h: it declares gl* functions that we must not link.
constexpr int kOsMesaFormat = 0x22, kOsMesaDepthBits = 0x30, kOsMesaProfile = 0x33, kOsMesaCoreProfile = 0x34,
              kOsMesaMajor = 0x36, kOsMesaMinor = 0x37;
using OsMesaContextHandle = void*;

struct OsMesa {
    SharedLibrary library{"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"};
    OsMesaContextHandle (*CreateContextAttribs)(const int* attributes, OsMesaContextHandle share) = nullptr;
    void (*DestroyContext)(OsMesaContextHandle) = nullptr;
    GLboolean (*MakeCurrent)(OsMesaContextHandle, void* buffer, GLenum type, GLsizei width, GLsizei height) = nullptr;
    void* (*GetProcAddress)(const char* name) = nullptr;
    bool complete = library.load(CreateContextAttribs, "OSMesaCreateContextAttribs") &&
                    library.load(DestroyContext, "OSMesaDestroyContext") &&
                    library.load(MakeCurrent, "OSMesaMakeCurrent") &&
                    library.load(GetProcAddress, "OSMesaGetProcAddress");
};

[[noreturn]] void fail(const char* what) {
    throw Error(ErrorKind::NoDisplay, {.what = what, .where = "OSMesa", .expected = "", .found = ""});
}

class OsMesaContext final : public HeadlessContext {
public:
    OsMesaContext() {
        if (!mesa_.complete) fail("libOSMesa.so.8 cannot be opened");
        const int attributes[] = {kOsMesaFormat,
                                  GL_RGBA,
                                  kOsMesaDepthBits,
                                  0,
                                  kOsMesaProfile,
                                  kOsMesaCoreProfile,
                                  kOsMesaMajor,
                                  3,
                                  kOsMesaMinor,
                                  3,
                                  0};
        context_ = mesa_.CreateContextAttribs(attributes, nullptr);
        if (!context_) fail("no OpenGL 3.3 core context");
        if (!mesa_.MakeCurrent(context_, screen_.data(), GL_UNSIGNED_BYTE, kScreenSize, kScreenSize)) {
            mesa_.DestroyContext(context_);
            fail("the context does not become current");
        }
        finish("OSMesa", [this](const char* name) { return mesa_.GetProcAddress(name); });
    }
    ~OsMesaContext() override { mesa_.DestroyContext(context_); }

private:
    static constexpr int kScreenSize = 16;  ///< of the default framebuffer, which nobody draws to

    OsMesa mesa_;
    OsMesaContextHandle context_ = nullptr;
    std::array<uint8_t, kScreenSize * kScreenSize * 4> screen_{};
};

}  // namespace

std::unique_ptr<HeadlessContext> createOsMesaContext() { return std::make_unique<OsMesaContext>(); }

}  // namespace lumi
