#pragma once
#include <memory>
#include <string>

#include "gl/functions.h"

namespace lumi {

/// Where a context without a window may come from.
enum class ContextKind { Egl, OsMesa };

/// An OpenGL 3.3 core context without a window, current on the thread that made it until it is destroyed. It has no
/// framebuffer of its own that can be relied on: draw into a Framebuffer. Both libraries are opened at run time.
class HeadlessContext {
public:
    virtual ~HeadlessContext() = default;
    HeadlessContext(const HeadlessContext&) = delete;
    HeadlessContext& operator=(const HeadlessContext&) = delete;

    const GlFunctions& gl() const { return *gl_; }
    /// "EGL surfaceless, llvmpipe (LLVM 15.0.6, 256 bits), OpenGL 4.5".
    const std::string& description() const { return description_; }

protected:
    HeadlessContext() = default;
    void finish(const std::string& platform, const GlFunctions::GetProcAddress& getProcAddress);

private:
    std::unique_ptr<GlFunctions> gl_;
    std::string description_;
};

/// EGL: surfaceless, then each device, then the default display with a pbuffer. Throws Error(NoDisplay) saying what
/// each attempt met.
std::unique_ptr<HeadlessContext> createEglContext();
/// Mesa's software renderer. Throws Error(NoDisplay) if the library is missing.
std::unique_ptr<HeadlessContext> createOsMesaContext();

/// EGL, or OSMesa where EGL fails. Throws Error(NoDisplay) with both reasons.
std::unique_ptr<HeadlessContext> createHeadlessContext();
std::unique_ptr<HeadlessContext> createHeadlessContext(ContextKind kind);

}  // namespace lumi
