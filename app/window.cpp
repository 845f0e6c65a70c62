#include "app/window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <memory>

#include "app/glfw_input.h"
#include "app/workbench.h"
#include "base/error.h"
#include "base/files.h"
#include "base/parallel.h"
#include "base/timer.h"
#include "gl/framebuffer.h"
#include "ui/commands.h"
#include "ui/preferences.h"

namespace lumi {

namespace {

constexpr const char* kRemedy = "; use `lumiscope render SCENE`, or `lumiscope view SCENE --offscreen --out DIR`";

[[noreturn]] void noDisplay(const std::string& what) {
    const char* reason = nullptr;
    glfwGetError(&reason);
    throw Error(ErrorKind::NoDisplay,
                {.what = what + (reason ? std::string(" (") + reason + ")" : std::string()) + kRemedy});
}

struct GlfwLibrary {
    GlfwLibrary() {
        if (!glfwInit()) noDisplay("there is no display to open a window on");
    }
    ~GlfwLibrary() { glfwTerminate(); }
};

struct WindowDeleter {
    void operator()(GLFWwindow* window) const { glfwDestroyWindow(window); }
};
using WindowHandle = std::unique_ptr<GLFWwindow, WindowDeleter>;

WindowHandle makeWindow(Extent2 size) {
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    glfwWindowHintString(GLFW_X11_CLASS_NAME, "lumiscope");
    glfwWindowHintString(GLFW_X11_INSTANCE_NAME, "lumiscope");
    WindowHandle window(glfwCreateWindow(size.width, size.height, "Lumiscope", nullptr, nullptr));
    if (!window) noDisplay("no window with OpenGL 3.3 could be opened");
    glfwMakeContextCurrent(window.get());
    glfwSwapInterval(1);
    glfwSetWindowSizeLimits(window.get(), 480, 360, GLFW_DONT_CARE, GLFW_DONT_CARE);
    return window;
}

class PointerShapes {
public:
    explicit PointerShapes(GLFWwindow* window) : window_(window) {}
    ~PointerShapes() {
        for (GLFWcursor* cursor : cursors_)
            if (cursor) glfwDestroyCursor(cursor);
    }
    void show(PointerShape shape) {
        if (shape == shown_) return;
        constexpr int kShapes[] = {GLFW_ARROW_CURSOR,   GLFW_HAND_CURSOR,    GLFW_IBEAM_CURSOR,
                                   GLFW_HRESIZE_CURSOR, GLFW_VRESIZE_CURSOR, GLFW_CROSSHAIR_CURSOR};
        GLFWcursor*& cursor = cursors_[static_cast<size_t>(shape)];
        if (!cursor) cursor = glfwCreateStandardCursor(kShapes[static_cast<size_t>(shape)]);
        glfwSetCursor(window_, cursor);
        shown_ = shape;
    }

private:
    GLFWwindow* window_;
    std::array<GLFWcursor*, 6> cursors_{};
    PointerShape shown_ = PointerShape::Arrow;
};

/// The window and what it shows.
class Workbench {
public:
    explicit Workbench(const WindowOptions& options)
        : options_(options),
          window_(makeWindow(options.size)),
          gl_([](const char* name) { return reinterpret_cast<void*>(glfwGetProcAddress(name)); }),
          session_(log_),
          interface_(gl_, session_, log_),
          pointers_(window_.get()),
          startCheck_(session_, log_, options.start) {
        connectInput(window_.get(), interface_.input());
        interface_.uiMap().setEnabled(!options.uiMap.empty());
        AppState& state = interface_.state();
        state.captures = options.captures;
        loadPreferences(state, preferencesPath());
        openAtStart(session_, state, options.start);
    }

    int run() {
        Timer sinceFrame;
        while (!glfwWindowShouldClose(window_.get()) && !interface_.state().quit) {
            // Between frames the thread sleeps: the processor belongs to the path tracer.
            glfwWaitEventsTimeout(interface_.busy() ? 1.0 / 120 : 1.0 / 60);
            startCheck_.check();
            if (!interface_.wantsFrame() && sinceFrame.elapsedMs() < kIdleMs) continue;
            const auto elapsed = static_cast<float>(sinceFrame.elapsedMs() * 1e-3);
            sinceFrame.restart();
            drawFrame(elapsed);
        }
        savePreferences(interface_.state(), preferencesPath());
        return 0;
    }

private:
    static constexpr double kIdleMs = 250;  ///< a frame at least this often, for text cursors and fading messages

    void drawFrame(float elapsed) {
        Extent2 target;
        glfwGetFramebufferSize(window_.get(), &target.width, &target.height);
        if (target.empty()) return;
        float scaleX = 1, scaleY = 1;
        glfwGetWindowContentScale(window_.get(), &scaleX, &scaleY);
        interface_.setScale(std::clamp(std::max(scaleX, scaleY), 0.75f, 4.0f));
        interface_.build(target, elapsed);
        gl_.BindFramebuffer(GL_FRAMEBUFFER, 0);
        interface_.draw(target);
        AppState& state = interface_.state();
        if (state.windowShotWanted) {
            state.windowShotWanted = false;
            state.pictureWriter.write(readPixels(gl_, target), windowShotPath(state));
        }
        glfwSwapBuffers(window_.get());
        pointers_.show(interface_.pointer());
        serveDesktop(state);
    }

    /// Clipboard, title, and the map of items for scripts.
    void serveDesktop(AppState& state) {
        if (!state.clipboard.empty()) glfwSetClipboardString(window_.get(), state.clipboard.c_str());
        state.clipboard.clear();
        const Scene* scene = state.document.scene();
        const std::string name = !scene                 ? ""
                                 : scene->title.empty() ? std::filesystem::path(scene->path).stem().string()
                                                        : scene->title;
        const std::string title = name.empty() ? "Lumiscope" : name + " - Lumiscope";
        if (title != title_) glfwSetWindowTitle(window_.get(), title.c_str());
        title_ = title;
        if (options_.uiMap.empty()) return;
        std::string map = interface_.uiMap().json();
        if (map == uiMap_) return;
        uiMap_ = std::move(map);
        writeFileAtomically(options_.uiMap, uiMap_);
    }

    const WindowOptions& options_;
    GlfwLibrary library_;
    MessageLog log_;
    WindowHandle window_;
    GlFunctions gl_;
    Session session_;
    Interface interface_;
    PointerShapes pointers_;
    StartCheck startCheck_;
    std::string title_, uiMap_;
};

}  // namespace

int runWindow(const WindowOptions& options) {
    lowerWorkerPriority();
    return Workbench(options).run();
}

}  // namespace lumi
