#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <fmt/format.h>

#include <array>
#include <cstring>
#include <vector>

#include "base/error.h"
#include "gl/context.h"
#include "gl/library.h"

namespace lumi {

namespace {

// clang-format off
#define LUMI_EGL_FUNCTIONS(X) \
    X(GetProcAddress, GETPROCADDRESS) X(GetDisplay, GETDISPLAY) X(Initialize, INITIALIZE) \
    X(Terminate, TERMINATE) X(BindAPI, BINDAPI) X(ChooseConfig, CHOOSECONFIG) X(CreateContext, CREATECONTEXT) \
    X(DestroyContext, DESTROYCONTEXT) X(CreatePbufferSurface, CREATEPBUFFERSURFACE) \
    X(DestroySurface, DESTROYSURFACE) X(MakeCurrent, MAKECURRENT) X(QueryString, QUERYSTRING)
// clang-format on

struct Egl {
    SharedLibrary library{"libEGL.so.1", "libEGL.so"};
    bool complete = true;
#define LUMI_EGL_MEMBER(name, type) PFNEGL##type##PROC name = nullptr;
    LUMI_EGL_FUNCTIONS(LUMI_EGL_MEMBER)
#undef LUMI_EGL_MEMBER
    PFNEGLGETPLATFORMDISPLAYEXTPROC GetPlatformDisplay = nullptr;
    PFNEGLQUERYDEVICESEXTPROC QueryDevices = nullptr;

    Egl() {
#define LUMI_EGL_LOAD(name, type) complete = library.load(name, "egl" #name) && complete;
        LUMI_EGL_FUNCTIONS(LUMI_EGL_LOAD)
#undef LUMI_EGL_LOAD
        if (!complete) return;
        GetPlatformDisplay =
            reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(GetProcAddress("eglGetPlatformDisplayEXT"));
        QueryDevices = reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(GetProcAddress("eglQueryDevicesEXT"));
    }
};

/// One way to a display, in the order they are tried.
struct Attempt {
    std::string name;
    EGLenum platform = 0;  ///< 0: the default display
    void* native = EGL_DEFAULT_DISPLAY;
};

std::vector<Attempt> attempts(const Egl& egl) {
    std::vector<Attempt> list;
    if (egl.GetPlatformDisplay) {
        list.push_back({"EGL surfaceless", EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY});
        std::array<EGLDeviceEXT, 16> devices{};
        EGLint count = 0;
        if (egl.QueryDevices && egl.QueryDevices(static_cast<EGLint>(devices.size()), devices.data(), &count))
            for (EGLint i = 0; i < count; ++i)
                list.push_back(
                    {fmt::format("EGL device {}", i), EGL_PLATFORM_DEVICE_EXT, devices[static_cast<size_t>(i)]});
    }
    list.push_back({"EGL pbuffer"});
    return list;
}

class EglContext final : public HeadlessContext {
public:
    EglContext(std::shared_ptr<const Egl> egl, const Attempt& attempt) : egl_(std::move(egl)) {
        try {
            open(attempt);
        } catch (...) {
            close();
            throw;
        }
    }
    ~EglContext() override { close(); }

private:
    [[noreturn]] static void fail(const Attempt& attempt, const char* what) {
        throw Error(ErrorKind::NoDisplay, {.what = what, .where = attempt.name, .expected = "", .found = ""});
    }

    void open(const Attempt& attempt) {
        display_ = attempt.platform ? egl_->GetPlatformDisplay(attempt.platform, attempt.native, nullptr)
                                    : egl_->GetDisplay(EGL_DEFAULT_DISPLAY);
        if (display_ == EGL_NO_DISPLAY) fail(attempt, "no such display");
        if (!egl_->Initialize(display_, nullptr, nullptr)) fail(attempt, "the display does not start");
        if (!egl_->BindAPI(EGL_OPENGL_API)) fail(attempt, "no desktop OpenGL");

        const char* extensions = egl_->QueryString(display_, EGL_EXTENSIONS);
        const bool surfaceless = extensions && std::strstr(extensions, "EGL_KHR_surfaceless_context");
        const EGLint configAttributes[] = {EGL_SURFACE_TYPE, surfaceless ? 0 : EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE,
                                           EGL_OPENGL_BIT, EGL_NONE};
        EGLConfig config = nullptr;
        EGLint count = 0;
        if (!egl_->ChooseConfig(display_, configAttributes, &config, 1, &count) || count == 0)
            fail(attempt, "no configuration for OpenGL");
        const EGLint contextAttributes[] = {
            EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
            EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
        context_ = egl_->CreateContext(display_, config, EGL_NO_CONTEXT, contextAttributes);
        if (context_ == EGL_NO_CONTEXT) fail(attempt, "no OpenGL 3.3 core context");
        if (!surfaceless) {
            const EGLint surfaceAttributes[] = {EGL_WIDTH, 16, EGL_HEIGHT, 16, EGL_NONE};
            surface_ = egl_->CreatePbufferSurface(display_, config, surfaceAttributes);
            if (surface_ == EGL_NO_SURFACE) fail(attempt, "no pbuffer");
        }
        if (!egl_->MakeCurrent(display_, surface_, surface_, context_))
            fail(attempt, "the context does not become current");
        finish(attempt.name, [this](const char* name) { return reinterpret_cast<void*>(egl_->GetProcAddress(name)); });
    }

    void close() {
        if (display_ == EGL_NO_DISPLAY) return;
        egl_->MakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        if (context_ != EGL_NO_CONTEXT) egl_->DestroyContext(display_, context_);
        if (surface_ != EGL_NO_SURFACE) egl_->DestroySurface(display_, surface_);
        egl_->Terminate(display_);
        display_ = EGL_NO_DISPLAY;
    }

    std::shared_ptr<const Egl> egl_;
    EGLDisplay display_ = EGL_NO_DISPLAY;
    EGLContext context_ = EGL_NO_CONTEXT;
    EGLSurface surface_ = EGL_NO_SURFACE;
};

}  // namespace

std::unique_ptr<HeadlessContext> createEglContext() {
    const auto egl = std::make_shared<Egl>();
    if (!egl->complete)
        throw Error(ErrorKind::NoDisplay,
                    {.what = "libEGL.so.1 cannot be opened", .where = "EGL", .expected = "", .found = ""});
    std::string reasons;
    for (const Attempt& attempt : attempts(*egl)) {
        try {
            return std::make_unique<EglContext>(egl, attempt);
        } catch (const Error& error) {
            reasons += (reasons.empty() ? "" : "; ") + std::string(error.what());
        }
    }
    throw Error(ErrorKind::NoDisplay, {.what = reasons, .where = "", .expected = "", .found = ""});
}

}  // namespace lumi
