#include "app/options/shared_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>

namespace lumi {

void addRepeatable(CLI::App& app, const char* name, std::vector<std::string>& values, const char* type,
                   const char* help) {
    app.add_option(name, values, help)
        ->type_name(type)
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void addShared(CLI::App& app, SharedText& text, SceneOptions& scene) {
    addRepeatable(app, "--module", scene.modules, "INSTANCE",
                  "Method that makes the image, as `list modules` names it");
    addRepeatable(app, "--set", text.set, "ID=VALUE", "Set any parameter of `list parameters`; repeatable");
    app.add_option("--size", text.size, "Size of the rendered image (the scene's, else 1280x720)")
        ->type_name("WxH")
        ->take_last();
    app.add_option("--spp", text.spp, "Samples a pixel in each frame (1)")->type_name("N")->take_last();
    app.add_option("--fps", text.fps, "Frames a second: frame f shows time f/F (60)")->type_name("F")->take_last();
    app.add_option("--camera", text.camera, "Camera of the scene by name or number (the first)")
        ->type_name("NAME|INDEX")
        ->take_last();
    app.add_option("--seed", text.seed, "Another set of random numbers (0)")->type_name("N")->take_last();
    app.add_option("--exposure", text.exposure, "Exposure of PNG, video and screen, in stops (the scene's)")
        ->type_name("EV")
        ->take_last();
}

void addCameraPath(CLI::App& app, SceneOptions& scene) {
    app.add_option("--camera-path", scene.cameraPath, "Keys for the camera: our own JSON or instant-ngp's")
        ->type_name("FILE")
        ->take_last();
}

void addMachine(CLI::App& app, MachineOptions& machine, bool computes) {
    app.add_flag("--json", machine.json, "Print the result as one JSON value on standard output");
    app.add_flag("--quiet", machine.quiet,
                 "Say nothing on standard error but errors; results are printed all the same");
    if (!computes) return;
    app.add_option("--threads", machine.threads, "Threads to use (one for each core); never changes the image")
        ->type_name("N")
        ->check(between(1, 1024));
    app.add_option("--isa", machine.isa, "Instruction set to use: baseline, v3 or v4 (the best)")->type_name("NAME");
    app.add_option("--memory-limit", machine.memoryLimit, "Refuse to use more, as 8G or 50% (75%)")->type_name("SIZE");
}

CLI::Validator oneOf(std::vector<std::string> names) {
    const auto check = [names = std::move(names)](const std::string& text) {
        if (std::find(names.begin(), names.end(), text) != names.end()) return std::string();
        return fmt::format("expected one of {}, found \"{}\"", fmt::join(names, ", "), text);
    };
    return CLI::Validator(check, "");
}

CLI::Validator between(double least, double most) {
    const auto check = [least, most](const std::string& text) {
        double value = 0;
        const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
        const bool number = code == std::errc() && end == text.data() + text.size();
        if (number && value >= least && value <= most) return std::string();
        return fmt::format("expected {} to {}, found \"{}\"", least, most, text);
    };
    return CLI::Validator(check, "");
}

void FramesText::add(CLI::App& app) {
    app.add_option("--frames", frames, "Frames 0..N-1, or A..B without B; history is empty at A (1)")
        ->type_name("N|A..B")
        ->take_last();
    app.add_option("--warm-up", warmUp, "Frames to run before the first without writing them (0)")
        ->type_name("N")
        ->take_last();
}

void ProgressText::add(CLI::App& app) {
    app.add_option("--progress", when, "auto (if standard error is a terminal), always or never")
        ->type_name("WHEN")
        ->check(oneOf({"auto", "always", "never"}));
}

Progress ProgressText::progress() const {
    return when == "always" ? Progress::Always : when == "never" ? Progress::Never : Progress::Auto;
}

}  // namespace lumi
