#include "image/video.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "base/error.h"

extern char** environ;

namespace lumi {
namespace fs = std::filesystem;
namespace {

constexpr int kMaxSide = 16384;

constexpr int kVideoDescriptor = 3;  ///< what ffmpeg knows its output as

/// Starts `arguments` (found in $PATH) with these standard input and error, and `video` as kVideoDescriptor. Its error
/// number, or 0.
int spawn(const std::vector<std::string>& arguments, int input, int messages, int video, pid_t& process) {
    std::vector<char*> argv;
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, messages, STDERR_FILENO);
    posix_spawn_file_actions_adddup2(&actions, video, kVideoDescriptor);
    // Signals that this program waits for itself end the other one as they end any.
    sigset_t none;
    sigemptyset(&none);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
    const int code = posix_spawnp(&process, argv[0], &actions, &attributes, argv.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    return code;
}

/// The output is an open file, not a name: an ffmpeg that outlives this program makes no file where the next run has
/// cleared away.
std::vector<std::string> command(const std::string& container, Extent2 extent, double fps) {
    return {"ffmpeg", "-hide_banner", "-loglevel", "error", "-f", "rawvideo", "-pixel_format", "rgb24", "-video_size",
            fmt::format("{}x{}", extent.width, extent.height), "-framerate", fmt::format("{:.6g}", fps), "-i", "pipe:0",
            "-an", "-vf",
            "pad=ceil(iw/2)*2:ceil(ih/2)*2,"
            "scale=out_color_matrix=bt709:out_range=tv:flags=accurate_rnd+full_chroma_int,format=yuv420p",
            "-c:v", "libx264", "-preset", "medium", "-crf", "16", "-colorspace", "bt709", "-color_primaries", "bt709",
            "-color_trc", "iec61966-2-1", "-color_range", "tv",
            // A fixed number of threads and no version strings: the same bytes on every machine.
            "-threads", "4", "-fflags", "+bitexact", "-flags:v", "+bitexact", "-movflags", "+faststart", "-f",
            container, "-y", fmt::format("file:/proc/self/fd/{}", kVideoDescriptor)};
}

/// What the child wrote, in one line.
std::string contents(int file) {
    std::string text;
    char buffer[4096];
    lseek(file, 0, SEEK_SET);
    for (ssize_t count; text.size() < 16384 && (count = read(file, buffer, sizeof buffer)) > 0;)
        text.append(buffer, static_cast<size_t>(count));
    while (!text.empty() && text.back() == '\n') text.pop_back();
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
}

}  // namespace

bool VideoPipe::available() {
    const char* path = std::getenv("PATH");
    std::string folders = path ? path : "/usr/bin";
    for (size_t begin = 0; begin <= folders.size();) {
        const size_t end = std::min(folders.find(':', begin), folders.size());
        if (access((folders.substr(begin, end - begin) + "/ffmpeg").c_str(), X_OK) == 0) return true;
        begin = end + 1;
    }
    return false;
}

VideoPipe::VideoPipe(const fs::path& path, Extent2 extent, double fps) : path_(path), extent_(extent) {
    if (extent.empty() || extent.width > kMaxSide || extent.height > kMaxSide)
        throwUsage({"a video of this size cannot be written", path.string(), fmt::format("1 to {} a side", kMaxSide),
                    fmt::format("{}x{}", extent.width, extent.height)});
    if (!(fps >= 0.01 && fps <= 1000))
        throwUsage({"not a frame rate", path.string(), "0.01 to 1000", fmt::format("{:g}", fps)});
    std::error_code ignored;
    if (fs::exists(path, ignored)) throwUsage({"exists already", path.string(), "a new file", ""});
    if (!available())
        throwUsage(
            {"writing video needs the ffmpeg program, which is not installed; install the package ffmpeg, or "
             "write PNG frames (--out frame-%04d.png)",
             path.string(), "", ""});
    if (path.has_parent_path()) fs::create_directories(path.parent_path(), ignored);

    const std::string extension = path.extension().string();
    partial_ = path.parent_path() / fmt::format("{}.{}.part{}", path.stem().string(), getpid(), extension);
    const int video = open(partial_.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (video < 0) fail(std::string("cannot be written (") + std::strerror(errno) + ")");
    // A socket rather than a pipe: writing to one whose reader is gone can be told not to raise SIGPIPE.
    int ends[2], code = 0;
    messages_ = memfd_create("ffmpeg-messages", MFD_CLOEXEC);
    if (messages_ < 0 || socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
        code = errno;
    } else {
        input_ = ends[0];
        const std::string container = extension.substr(std::min<size_t>(1, extension.size()));
        code = spawn(command(container, extent, fps), ends[1], messages_, video, process_);
        close(ends[1]);
    }
    close(video);
    if (code != 0) {
        process_ = -1;
        fail(std::string("cannot start ffmpeg (") + std::strerror(code) + ")");
    }
    pixels_.resize(static_cast<size_t>(extent.area()) * 3);
}

VideoPipe::~VideoPipe() {
    if (process_ > 0) {
        kill(process_, SIGKILL);
        closeInput();
        waitForExit();
        std::error_code ignored;
        fs::remove(partial_, ignored);
    }
    closeInput();
    if (messages_ >= 0) close(messages_);
}

void VideoPipe::write(const Image8& frame) {
    assert(frame.extent == extent_);
    if (process_ <= 0) fail("is finished already");
    const auto area = static_cast<size_t>(extent_.area());
    for (size_t i = 0; i < area; ++i)
        for (size_t c = 0; c < 3; ++c) pixels_[i * 3 + c] = frame.rgba[i * 4 + c];
    for (size_t sent = 0; sent < pixels_.size();) {
        const ssize_t count = send(input_, pixels_.data() + sent, pixels_.size() - sent, MSG_NOSIGNAL);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) {
            closeInput();
            waitForExit();
            fail("ffmpeg stopped");
        }
        sent += static_cast<size_t>(count);
    }
    ++frames_;
}

void VideoPipe::finish() {
    if (process_ <= 0) return;
    closeInput();
    const int status = waitForExit();
    if (frames_ == 0) fail("no frame was written");
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) fail("ffmpeg failed");
    if (renameat2(AT_FDCWD, partial_.c_str(), AT_FDCWD, path_.c_str(), RENAME_NOREPLACE) != 0)
        fail(std::string("cannot be written (") + std::strerror(errno) + ")");
}

void VideoPipe::closeInput() {
    if (input_ >= 0) close(input_);
    input_ = -1;
}

int VideoPipe::waitForExit() {
    int status = -1;
    while (waitpid(process_, &status, 0) < 0 && errno == EINTR) continue;
    process_ = -1;
    return status;
}

void VideoPipe::fail(const std::string& what) {
    const std::string words = messages_ >= 0 ? contents(messages_) : "";
    closeInput();
    if (messages_ >= 0) close(messages_);
    messages_ = -1;
    std::error_code ignored;
    fs::remove(partial_, ignored);
    throw Error(ErrorKind::Resources, {words.empty() ? what : what + ": " + words, path_.string(), "", ""});
}

}  // namespace lumi
