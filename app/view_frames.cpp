#include <fmt/format.h>

#include <functional>

#include "app/view_driver.h"
#include "base/error.h"
#include "session/clock.h"

namespace lumi {

/// The active pane's picture with its layers, beside the window's.
void ViewDriver::saveBuffers(const std::filesystem::path& path) {
    const auto answers = [&] {
        int count = 0;
        for (const Message& message : log_.messages())
            if (message.text.find(path.string()) != std::string::npos) count += message.repeats;
        return count;
    };
    const int before = answers();
    session_.saveView(interface_.state().activePane, path, options_.buffers, options_.half);
    waitUntil("saving " + path.string(), "", [&] { return answers() > before; });
    if (!std::filesystem::exists(path)) throw Error(ErrorKind::BadInput, {.what = log_.messages().back().text});
    files_.push_back(path);
}

void ViewDriver::waitForFrame(FrameNumber number) {
    const AppState& state = interface_.state();
    waitUntil("frame " + std::to_string(number), "", [&] {
        return state.snapshot && !state.snapshot->preview && state.snapshot->frame == number &&
               state.snapshot->revision >= session_.revision();
    });
}

void ViewDriver::runFrames(const FrameRange& range, int64_t warmUp) {
    session_.setRendering(false);
    run({"view", "wait-load", {}, ""});
    const FrameNumber first = range.begin - warmUp;
    const Clock clock{0, 0, session_.document().render().fps};
    session_.set("time", clock.at(first));
    session_.restart(first);
    session_.setPlaying(true);
    for (FrameNumber number = first; number < range.end; ++number) {
        say(fmt::format("frame {} of {}..{}", number, first, range.end));
        if (number > first) session_.step();
        waitForFrame(number);
        if (number >= range.begin) shot(fmt::format("{}.{:04}", options_.start.scene.stem().string(), number));
    }
}

void ViewDriver::say(std::string what) {
    std::lock_guard lock(sayMutex_);
    doing_ = std::move(what);
}

std::string ViewDriver::progress() const {
    std::string text;
    {
        std::lock_guard lock(sayMutex_);
        text = doing_;
    }
    const LoadStatus loading = session_.loadStatus();
    if (loading.loading) return fmt::format("{}  {:3.0f}%  {}", text, 100 * loading.fraction, loading.step);
    if (const auto shown = session_.snapshot(); shown && shown->accumulatedSamples > 0)
        text += fmt::format("  {} spp", shown->accumulatedSamples);
    return text;
}

}  // namespace lumi
