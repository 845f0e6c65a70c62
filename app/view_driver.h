#pragma once
#include <functional>
#include <memory>
#include <mutex>
#include <nlohmann/json_fwd.hpp>

#include "app/view.h"
#include "app/view_script.h"
#include "app/workbench.h"
#include "base/timer.h"
#include "gl/context.h"
#include "gl/framebuffer.h"

namespace lumi {

/// The window's content on a framebuffer without a display, driven line by line. A frame of the UI counts 1/60 s
/// however long it took, so that scripts mean the same on every machine.
class ViewDriver {
public:
    explicit ViewDriver(const ViewOptions& options);

    void run(const ScriptLine& line);
    /// Draws the frames one after the other, time f/fps in frame f, and shoots each as `<scene>.%04d.png`.
    void runFrames(const FrameRange& range, int64_t warmUp);
    /// What it is doing, for a line of progress; from any thread.
    std::string progress() const;
    /// The last events take effect.
    void finish();
    /// {"files", "context", "first_image_s", "ui_frames", "ui_ms": {"median","p99","worst"}, "engine_frames",
    ///  "warnings", "errors"}.
    nlohmann::json report() const;

private:
    void build(int frames = 1);
    void settle();  ///< builds until every event was taken and has been seen twice
    void wait(const ScriptLine& line, const std::function<bool()>& until);
    void pointer(const ScriptLine& line);
    void click(const ScriptLine& line, int times);
    void drag(const ScriptLine& line);
    void keys(const ScriptLine& line);
    void waits(const ScriptLine& line);
    void shot(const std::string& name);
    void saveBuffers(const std::filesystem::path& path);
    void waitUntil(const std::string& what, const std::string& where, const std::function<bool()>& until);
    void waitForFrame(FrameNumber number);
    void say(std::string what);
    Vec2 centreOf(const ScriptLine& line, const std::string& name);
    void strike(Key key, bool down) { interface_.input().add(KeyChanged{key, down}); }

    const ViewOptions& options_;
    std::unique_ptr<HeadlessContext> context_;
    MessageLog log_;
    Session session_;
    Interface interface_;
    StartCheck startCheck_;
    std::unique_ptr<Framebuffer> framebuffer_;
    Extent2 size_;
    float scale_ = 1;
    Timer sinceStart_;
    double firstImageS_ = -1;
    int frames_ = 0;
    mutable std::mutex sayMutex_;
    std::string doing_ = "opening";
    std::vector<std::filesystem::path> files_;
};

}  // namespace lumi
