#include <gtest/gtest.h>
#include <stdlib.h>

#include <cstdio>
#include <filesystem>

#include "base/files.h"
#include "image/video.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"
#include "support/test_images.h"

namespace lumi {
namespace {
using test::expectError;

/// What a command prints.
std::string outputOf(const std::string& command) {
    std::string text;
    FILE* pipe = popen(command.c_str(), "r");
    char buffer[256];
    while (std::fgets(buffer, sizeof buffer, pipe)) text += buffer;
    pclose(pipe);
    return text;
}

Image8 flat(Extent2 extent, uint8_t r, uint8_t g, uint8_t b) {
    Image8 image{extent, {}};
    for (int64_t i = 0; i < extent.area(); ++i) image.rgba.insert(image.rgba.end(), {r, g, b, 255});
    return image;
}

TEST(Video, FramesOfOddSizeBecomeAFileThatPlays) {
    if (!VideoPipe::available()) GTEST_SKIP() << "ffmpeg is not installed";
    const test::TemporaryFolder folder;
    const Extent2 extent{65, 33};
    {
        VideoPipe video(folder / "out.mp4", extent, 30);
        for (int frame = 0; frame < 12; ++frame) video.write(flat(extent, 200, 100, 50));
        video.finish();
    }
    const std::string probe = outputOf(
        "ffprobe -v error -select_streams v -count_frames -show_entries "
        "stream=codec_name,width,height,pix_fmt,r_frame_rate,nb_read_frames -of csv=p=0 " +
        (folder / "out.mp4").string());
    EXPECT_EQ(probe, "h264,66,34,yuv420p,30/1,12\n");
    // The decoded colour is the one that went in.
    const std::string raw = (folder / "frame.rgb").string();
    outputOf("ffmpeg -v error -i " + (folder / "out.mp4").string() + " -frames:v 1 -f rawvideo -pix_fmt rgb24 " + raw +
             " 2>&1");
    const std::vector<uint8_t> pixels = readFile(raw);
    ASSERT_EQ(pixels.size(), 66u * 34 * 3);
    const size_t centre = (17u * 66 + 33) * 3;
    EXPECT_NEAR(pixels[centre], 200, 6);
    EXPECT_NEAR(pixels[centre + 1], 100, 6);
    EXPECT_NEAR(pixels[centre + 2], 50, 6);
}

TEST(Video, ExistingFilesAndBadSizesAreRefused) {
    const test::TemporaryFolder folder;
    writeFileAtomically(folder / "old.mp4", "precious");
    expectError(ErrorKind::Usage, [&] { VideoPipe(folder / "old.mp4", {64, 64}, 30); }, {"old.mp4"});
    expectError(ErrorKind::Usage, [&] { VideoPipe(folder / "new.mp4", {0, 64}, 30); }, {"new.mp4"});
    expectError(ErrorKind::Usage, [&] { VideoPipe(folder / "new.mp4", {64, 64}, 0); }, {"frame rate"});
    EXPECT_EQ(readTextFile(folder / "old.mp4"), "precious");
}

TEST(Video, AbandonedVideosLeaveNoFile) {
    if (!VideoPipe::available()) GTEST_SKIP() << "ffmpeg is not installed";
    const test::TemporaryFolder folder;
    {
        VideoPipe video(folder / "out.mp4", {64, 64}, 30);
        video.write(flat({64, 64}, 1, 2, 3));
    }
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Video, FfmpegsFailureIsReportedNotASignal) {
    if (!VideoPipe::available()) GTEST_SKIP() << "ffmpeg is not installed";
    const test::TemporaryFolder folder;
    // No container of that name: ffmpeg ends at once, while frames are still being written.
    VideoPipe video(folder / "out.nonsense", {512, 512}, 30);
    expectError(ErrorKind::Resources,
                [&] {
                    for (int frame = 0; frame < 50; ++frame) video.write(flat({512, 512}, 1, 2, 3));
                    video.finish();
                },
                {"out.nonsense", "ffmpeg"});
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Video, WithoutFfmpegTheMessageSaysWhatToDo) {
    const test::TemporaryFolder folder;
    const std::string path = getenv("PATH");
    setenv("PATH", folder.path().c_str(), 1);
    EXPECT_FALSE(VideoPipe::available());
    expectError(ErrorKind::Usage, [&] { VideoPipe(folder / "out.mp4", {64, 64}, 30); }, {"ffmpeg", "install", "PNG"});
    setenv("PATH", path.c_str(), 1);
}

}  // namespace
}  // namespace lumi
