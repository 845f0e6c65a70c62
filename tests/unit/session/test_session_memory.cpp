// Scenes loaded, cancelled and loaded again in one process leave memory where it was.
#include <cstdlib>
#include <sstream>

#include "base/error.h"
#include "base/files.h"
#include "base/memory.h"
#include "scene/load.h"
#include "session/frame_engine.h"
#include "support/session_test.h"
#include "support/temporary_folder.h"

namespace lumi::test {
namespace {

constexpr int kLoads = 200, kWarmUp = 60;
constexpr size_t kAllowedBytes = size_t(12) << 20;  ///< what allocators keep; one Cornell box with its frames is less

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;  // freed memory is held back to catch its use
#else
constexpr bool kSanitized = false;
#endif

/// Two small scenes, or those that $LUMISCOPE_MEMORY_SCENES names, separated by colons.
std::vector<std::filesystem::path> scenes(const TemporaryFolder& folder) {
    std::vector<std::filesystem::path> paths;
    if (const char* named = std::getenv("LUMISCOPE_MEMORY_SCENES")) {
        std::istringstream stream(named);
        for (std::string path; std::getline(stream, path, ':');) paths.emplace_back(path);
        return paths;
    }
    writeFileAtomically(folder / "triangle.obj", std::string_view("v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n"));
    return {kCornell, folder / "triangle.obj"};
}

/// Growth after the warm-up, which is allowed what a big scene keeps for the next one of its size.
void expectNoGrowth(size_t after, size_t warm) {
    std::printf("    %s after %d loads, %s after %d\n", formatBytes(warm).c_str(), kWarmUp, formatBytes(after).c_str(),
                kLoads);
    if (kSanitized) return;
    EXPECT_LT(after, warm + warm / 20 + kAllowedBytes);
}

using SessionMemory = SessionTest;

/// Resident memory when loads that were cancelled have come to their end.
size_t restingBytes() {
    size_t least = residentBytes();
    for (int still = 0; still < 10; ++still) {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        const size_t now = residentBytes();
        if (now + (size_t(1) << 20) < least) still = 0;
        least = std::min(least, now);
    }
    return least;
}

TEST_F(SessionMemory, LoadingCancellingAndLoadingAgainInASession) {
    TemporaryFolder folder;
    const auto paths = scenes(folder);
    const auto load = [&](const std::filesystem::path& path, int width, bool cancel) {
        session.open(path, {}, {{"render.width", std::to_string(width)}, {"render.height", "12"}});
        if (cancel) return session.cancelLoading();
        waitFor("the scene", [&] { return !session.loadStatus().loading; });
        waitFor("its picture", [&] {
            const auto snapshot = session.snapshot();
            return snapshot && snapshot->extent.width == width &&
                   snapshot->scene->scene->path == session.document().scene()->path;
        });
    };
    size_t warm = 0;
    for (int i = 0; i <= kLoads; ++i) {
        // What is measured holds the same scene both times.
        const bool measured = i == kWarmUp || i == kLoads;
        load(paths[measured ? 0 : static_cast<size_t>(i) % paths.size()], 16 + (measured ? 0 : i % 7),
             !measured && i % 3 == 2);
        if (i == kWarmUp) warm = restingBytes();
    }
    expectNoGrowth(restingBytes(), warm);
}

TEST(HeadlessMemory, LoadingAndRenderingAgain) {
    TemporaryFolder folder;
    const auto paths = scenes(folder);
    size_t warm = 0;
    for (int i = 0; i < kLoads; ++i) {
        MessageLog log;
        std::stop_source stop;
        LoadOptions options;
        options.stop = stop.get_token();
        // Every third load is stopped, each a little further on its way.
        if (i % 3 == 2)
            options.progress = [&](float done, const std::string&) {
                if (done >= static_cast<float>(i % 10) / 10) stop.request_stop();
            };
        try {
            Document document(loadScene(paths[static_cast<size_t>(i) % paths.size()], log, options));
            document.set("render.width", 16);
            document.set("render.height", 12);
            FrameEngine engine(log);
            EXPECT_TRUE(engine.advance({document, 0, true, {}, {}}));
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::Interrupted) << error.what();
        }
        if (i == kWarmUp) warm = residentBytes();
    }
    expectNoGrowth(residentBytes(), warm);
}

}  // namespace
}  // namespace lumi::test
