#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <optional>
#include <thread>

#include "app/render_command.h"
#include "base/error.h"
#include "base/files.h"
#include "image/png.h"
#include "session/view_buffers.h"

namespace lumi {
namespace fs = std::filesystem;
namespace {

bool isNumber(const std::string& text) {
    return !text.empty() && text.size() <= 9 && text.find_first_not_of("0123456789") == std::string::npos;
}

/// Is there no such process any more?
bool hasEnded(int process) { return kill(process, 0) != 0 && errno == ESRCH; }
bool hasEnded(const std::string& process) { return isNumber(process) && hasEnded(std::stoi(process)); }

template <class IsLeftover>
void removeIf(const fs::path& folder, IsLeftover isLeftover) {
    std::error_code failure;
    std::vector<fs::path> leftovers;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder.empty() ? "." : folder, failure))
        if (isLeftover(entry.path().filename().string())) leftovers.push_back(entry.path());
    for (const fs::path& leftover : leftovers) fs::remove(leftover, failure);
}

/// Removes unfinished videos of this name whose process was killed: <stem>.<process>.part<extension>, see VideoPipe.
void removeLeftovers(const fs::path& video) {
    const std::string head = video.stem().string() + ".", tail = ".part" + video.extension().string();
    removeIf(video.parent_path(), [&](const std::string& name) {
        return name.size() > head.size() + tail.size() && name.starts_with(head) && name.ends_with(tail) &&
               hasEnded(name.substr(head.size(), name.size() - head.size() - tail.size()));
    });
}

/// The file to compare the image `name` with: <stem>.<process>.check<extension>.
fs::path checkName(const fs::path& name) {
    return fs::path(name).replace_extension(fmt::format(".{}.check{}", getpid(), name.extension().string()));
}

/// Removes what killed processes left in a video's own folder: frames half written, and images they were compared with.
void removeFrameLeftovers(const fs::path& folder) {
    removeIf(folder, [](const std::string& name) {
        const std::optional<Unfinished> part = unfinishedFile(name);
        if (part && !hasEnded(part->process)) return false;
        const fs::path image = part ? part->whole : fs::path(name), stem = image.stem();
        if (image.extension() != ".png") return false;
        if (stem.extension() != ".check") return part && isNumber(stem.string());
        const fs::path checked = stem.stem();  // <frame>.<process>, see checkName()
        return isNumber(checked.stem().string()) && checked.has_extension() &&
               hasEnded(checked.extension().string().substr(1));
    });
}

}  // namespace

std::string numberedName(const std::string& pattern, int64_t number, bool* hasNumber) {
    std::string name;
    if (hasNumber) *hasNumber = false;
    for (size_t i = 0; i < pattern.size(); ++i) {
        if (pattern[i] != '%') {
            name += pattern[i];
            continue;
        }
        size_t end = i + 1;
        while (end < pattern.size() && std::isdigit(static_cast<unsigned char>(pattern[end]))) ++end;
        const std::string digits = pattern.substr(i + 1, end - i - 1);
        if (end < pattern.size() && pattern[end] == '%' && digits.empty()) {
            name += '%';
        } else if (end < pattern.size() && pattern[end] == 'd' && digits.size() <= 2) {
            const int width = digits.empty() ? 0 : std::stoi(digits);
            name += digits.empty() || digits[0] != '0' ? fmt::format("{:{}}", number, width)
                                                       : fmt::format("{:0{}}", number, width);
            if (hasNumber) *hasNumber = true;
        } else {
            throwUsage(
                {"not understood after %", pattern, "%d or %04d for the frame number, %% for a percent sign", ""});
        }
        i = end;
    }
    return name;
}

RenderOutputs::RenderOutputs(const std::vector<std::string>& names, const OutputChoice& choice, double fps,
                             MessageLog& log)
    : choice_(choice), fps_(fps), log_(log) {
    for (const std::string& name : names) {
        Output output{name, lowerExtension(name), false, {}};
        numberedName(name, 0, &output.numbered);
        if (output.extension != ".exr" && output.extension != ".png" && output.extension != ".mp4")
            throwUsage({"cannot write this kind of file", name, ".exr, .png or .mp4", '"' + output.extension + '"'});
        if (output.extension == ".mp4" && output.numbered)
            throwUsage({"a video holds all frames", name, "a name without %d", ""});
        std::error_code failure;  // what cannot be looked at cannot be written either
        if (fs::is_directory(name, failure)) throwUsage({"is a folder", name, "a file name", ""});
        if (output.extension == ".mp4" && VideoPipe::available()) {
            output = videoFrames(name);
        } else if (output.extension == ".mp4") {
            output = {fs::path(name).replace_extension(".%04d.png").string(), ".png", true, {}};
            log.warning(fmt::format("{}: no ffmpeg program to write video with; writing {}", name, output.name));
        }
        requireWritable(output.video.empty() ? fs::path(numberedName(output.name, 0)) : output.video);
        outputs_.push_back(output);
    }
}

RenderOutputs::Output RenderOutputs::videoFrames(const std::string& name) const {
    const fs::path video = numberedName(name, 0);
    std::error_code failure;
    if (fs::exists(video, failure)) throwUsage({"exists already", video.string(), "a new file", ""});
    removeLeftovers(video);
    return {name + ".frames/%06d.png", ".png", true, video};  // % in the name stays doubled
}

bool RenderOutputs::wantsLayers(bool last) const {
    return std::any_of(outputs_.begin(), outputs_.end(),
                       [&](const Output& o) { return o.extension == ".exr" && (o.numbered || last); });
}

std::vector<std::string> RenderOutputs::numberedFiles(int64_t frame) const {
    std::vector<std::string> names;
    for (const Output& output : outputs_)
        if (output.numbered) names.push_back(numberedName(output.name, frame));
    return names;
}

bool RenderOutputs::allThere(const std::vector<std::string>& names) {
    return std::all_of(names.begin(), names.end(), [](const std::string& name) { return fs::exists(name); });
}

bool RenderOutputs::hasLastFrameFiles() const {
    return std::any_of(outputs_.begin(), outputs_.end(), [](const Output& output) { return !output.numbered; });
}

void RenderOutputs::throwOtherState(const std::string& name) {
    throwUsage({"exists already and is another image", name, "this frame, or no file", ""});
}

void RenderOutputs::write(const FrameOutput& frame, const Document& document, const StateLog& log, bool last) {
    std::string state;
    for (const Output& output : outputs_) {
        if (!output.numbered && !last) continue;
        if (state.empty()) state = log.json(choice_.json());
        const std::string name = numberedName(output.name, frame.number);
        if (output.numbered && fs::exists(name)) {
            if (stateTextOf(name) != state) throwOtherState(name);
            continue;
        }
        exportView(name, frame, document, choice_, state).warn(log_);
        if (output.video.empty()) files_.push_back(name);
    }
}

void RenderOutputs::verify(const FrameOutput& frame, const Document& document, const StateLog& log) const {
    const std::string state = log.json(choice_.json());
    for (const std::string& name : numberedFiles(frame.number)) {
        const fs::path again = unusedPath(checkName(name));
        exportView(again, frame, document, choice_, state);
        const bool same = readFile(name) == readFile(again);
        fs::remove(again);
        if (!same) throwOtherState(name);
    }
}

void RenderOutputs::finishVideo(const Output& output, int64_t begin, int64_t end, std::stop_token stop) {
    std::unique_ptr<VideoPipe> pipe;
    const auto requireGoingOn = [&] {
        if (stop.stop_requested()) throw Error(ErrorKind::Interrupted, {"interrupted", "", "", ""});
    };
    try {
        for (int64_t frame = begin; frame < end; ++frame) {
            requireGoingOn();
            const Image8 picture = readPng(numberedName(output.name, frame)).image8();
            if (!pipe) pipe = std::make_unique<VideoPipe>(output.video, picture.extent, fps_);
            pipe->write(picture);
        }
        if (!pipe) return;
        pipe->finish();
    } catch (const Error&) {
        // an interrupt of the terminal ends ffmpeg, too, and maybe first
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        requireGoingOn();
        throw;
    }
    files_.push_back(output.video.string());
    for (int64_t frame = begin; frame < end; ++frame) fs::remove(numberedName(output.name, frame));
    const fs::path folder = fs::path(numberedName(output.name, begin)).parent_path();
    removeFrameLeftovers(folder);
    std::error_code notEmpty;
    fs::remove(folder, notEmpty);  // unless others keep files there
}

void RenderOutputs::finish(int64_t begin, int64_t end, std::stop_token stop) {
    for (const Output& output : outputs_)
        if (!output.video.empty()) finishVideo(output, begin, end, stop);
}

}  // namespace lumi
