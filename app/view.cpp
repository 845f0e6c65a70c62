#include "app/view.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/progress_line.h"
#include "app/view_driver.h"
#include "app/view_script.h"
#include "base/parallel.h"
#include "params/json_text.h"

namespace lumi {

namespace {

/// Without a script: wait for the picture, one shot.
std::vector<ScriptLine> plainShot(const ViewOptions& options) {
    const std::string name = options.start.scene.empty() ? "window" : options.start.scene.stem().string();
    const std::string waits =
        options.start.scene.empty() ? "" : "wait-load\nwait-spp " + std::to_string(options.samples) + "\n";
    return parseViewScript(waits + "shot " + name + "\n", "view");
}

}  // namespace

int runView(const ViewOptions& options) {
    lowerWorkerPriority();
    const std::vector<ScriptLine> script = options.script.empty() ? plainShot(options) : readViewScript(options.script);
    std::filesystem::create_directories(options.out);
    ViewDriver driver(options);
    {
        const bool shown = !options.quiet && (options.progress == Progress::Always ||
                                              (options.progress == Progress::Auto && stderrIsTerminal()));
        const ProgressLine progress(shown, [&] { return driver.progress(); });
        if (options.frames) driver.runFrames(*options.frames, options.warmUp);
        else
            for (const ScriptLine& line : script) driver.run(line);
        driver.finish();
    }
    const nlohmann::json report = driver.report();
    if (options.json) {
        std::printf("%s\n", jsonText(report, 1).c_str());
    } else {
        for (const auto& file : report["files"]) std::printf("%s\n", file.get<std::string>().c_str());
        if (!options.quiet)
            std::fprintf(stderr, "%s; UI thread %.2f ms a frame (p99)\n", report["context"].get<std::string>().c_str(),
                         report["ui_ms"]["p99"].get<double>());
    }
    return 0;
}

}  // namespace lumi
