#include <fmt/format.h>

#include <algorithm>

#include "app/render_command.h"
#include "base/error.h"
#include "base/files.h"
#include "session/view_buffers.h"

namespace lumi {
namespace fs = std::filesystem;

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
            throwUsage({"not understood after %", pattern, "%d or %04d for the frame number, %% for a percent sign", ""});
        }
        i = end;
    }
    return name;
}

RenderOutputs::RenderOutputs(const std::vector<std::string>& names, const OutputChoice& choice, double fps,
                             MessageLog& log)
    : choice_(choice), fps_(fps) {
    for (const std::string& name : names) {
        Output output{name, lowerExtension(name), false};
        numberedName(name, 0, &output.numbered);
        if (output.extension != ".exr" && output.extension != ".png" && output.extension != ".mp4")
            throwUsage({"cannot write this kind of file", name, ".exr, .png or .mp4", '"' + output.extension + '"'});
        if (output.extension == ".mp4" && output.numbered)
            throwUsage({"a video holds all frames", name, "a name without %d", ""});
        if (fs::is_directory(name)) throwUsage({"is a folder", name, "a file name", ""});
        if (output.extension == ".mp4" && !VideoPipe::available()) {
            output = {fs::path(name).replace_extension(".%04d.png").string(), ".png", true};
            log.warning(fmt::format("{}: no ffmpeg program to write video with; writing {}", name, output.name));
        }
        if (output.extension == ".mp4" && fs::exists(numberedName(name, 0)))
            throwUsage({"exists already", name, "a new file", ""});
        outputs_.push_back(output);
    }
}

bool RenderOutputs::wantsLayers(bool last) const {
    return std::any_of(outputs_.begin(), outputs_.end(),
                       [&](const Output& o) { return o.extension == ".exr" && (o.numbered || last); });
}

void RenderOutputs::write(const FrameOutput& frame, const Document& document, const StateLog& log, bool last) {
    std::string state;
    for (const Output& output : outputs_) {
        if (output.extension == ".mp4") {
            writeVideo(output, frame, document);
        } else if (output.numbered || last) {
            if (state.empty()) state = log.json(choice_.json());
            const std::string name = numberedName(output.name, frame.number);
            exportView(name, frame, document, choice_, state);
            files_.push_back(name);
        }
    }
}

void RenderOutputs::writeVideo(const Output& output, const FrameOutput& frame, const Document& document) {
    const fs::path path = numberedName(output.name, 0);
    auto video = std::find_if(videos_.begin(), videos_.end(), [&](const Video& v) { return v.path == path; });
    DisplayInfo info;
    const auto pixels = drawView(frame, document.view(choice_.view), info);
    if (video == videos_.end()) {
        videos_.push_back({path, std::make_unique<VideoPipe>(path, pixels->extent, fps_)});
        video = videos_.end() - 1;
    }
    video->pipe->write(*pixels);
}

void RenderOutputs::finish() {
    for (Video& video : videos_) {
        video.pipe->finish();
        files_.push_back(video.path.string());
    }
    videos_.clear();
}

}  // namespace lumi
