#pragma once
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/timer.h"
#include "session/session.h"

namespace lumi::test {

inline const std::filesystem::path kCornell = LUMISCOPE_SOURCE_DIR "/scenes/cornell.json";

/// A session on the Cornell box, 32 x 24 pixels, and ways to wait for what it does.
class SessionTest : public testing::Test {
protected:
    /// Waits until `condition` holds; fails after minutes, which only a deadlock takes: frames are drawn at a low
    /// priority.
    void waitFor(const char* what, const std::function<bool()>& condition) {
        Timer timer;
        while (!condition()) {
            ASSERT_LT(timer.elapsedMs(), 240'000) << "waited in vain: " << what;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    }
    void open(std::vector<std::pair<std::string, std::string>> set = {}) {
        set.insert(set.begin(), {{"render.width", "32"}, {"render.height", "24"}});
        session.open(kCornell, {}, set);
        waitFor("the scene and its first picture", [&] { return session.snapshot() != nullptr; });
    }
    FrameNumber shownFrame() { return session.snapshot()->frame; }
    /// Pauses, and waits until nothing is drawn any more.
    void pause() {
        session.setRendering(false);
        waitFor("the end of what is being drawn", [&] { return !session.busy(); });
    }
    Image result() { return *session.snapshot()->results.at("accumulate"); }
    bool logged(const std::string& part) {
        for (const Message& message : log.messages())
            if (message.text.find(part) != std::string::npos) return true;
        return false;
    }

    MessageLog log;
    Session session{log};
};

}  // namespace lumi::test
