#include "app/commands.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "base/error.h"
#include "base/isa.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "reconstruct/catalog.h"

namespace lumi {
namespace {

/// Says which --set has no effect because the method that it belongs to does not run.
void warnOfIdle(const Document& document, const SceneOptions& options, MessageLog& log) {
    const std::vector<std::string> running = document.activeInstances();
    const auto catalog = moduleCatalog();
    for (const TypedValue& value : options.values) {
        const std::string instance = value.id.substr(0, value.id.find('.'));
        const std::string module = instance.substr(0, instance.find('@'));
        const bool isModule =
            std::any_of(catalog.begin(), catalog.end(), [&](const ModuleEntry& e) { return module == e.id; });
        if (!isModule || std::find(running.begin(), running.end(), instance) != running.end()) continue;
        log.warning(fmt::format("{} {}={}: no effect, {} does not run; {} does", value.option, value.id, value.text,
                                instance, fmt::join(running, " and ")));
    }
}

}  // namespace

void requireWholeOutput() {
    const bool flushed = std::fflush(stdout) == 0;
    const std::string reason = flushed ? "" : std::string(" (") + std::strerror(errno) + ")";
    if (!flushed || std::ferror(stdout))
        throw Error(ErrorKind::Resources, {"standard output could not be written" + reason, "", "", ""});
}

void applyMachine(const MachineOptions& machine) {
    if (machine.threads > 0) setThreadCount(machine.threads);
    if (!machine.isa.empty()) setIsa(parseIsa(machine.isa));
    if (!machine.memoryLimit.empty()) setMemoryLimit(parseBytes(machine.memoryLimit, "--memory-limit"));
}

std::shared_ptr<const Scene> openScene(const std::filesystem::path& file, const SceneOptions& options, MessageLog& log,
                                       std::stop_token stop) {
    LoadOptions load;
    load.stop = stop;
    for (const TypedValue& value : options.values) load.choice.set(value.id, value.text, value.option);
    return loadScene(file, log, load);
}

void printMessages(MessageLog& log, const MachineOptions& machine) {
    const auto print = [quiet = machine.quiet](const Message& message) {
        if (quiet && message.severity != Severity::Error) return;
        const char* kinds[] = {"", "warning: ", "error: "};
        std::fprintf(stderr, "%s%s\n", kinds[static_cast<int>(message.severity)], message.text.c_str());
    };
    for (const Message& message : log.messages()) print(message);
    log.setListener(print);
}

std::optional<CameraPath> readCameraPathOf(const SceneOptions& options) {
    if (options.cameraPath.empty()) return std::nullopt;
    return readCameraPath(options.cameraPath);
}

void followCameraPath(Document& document, const std::optional<CameraPath>& path) {
    if (!path) return;
    const SceneCamera::Key key = path->at(document.time());
    document.set("camera.eye", key.eye);
    document.set("camera.look-at", key.target);
    document.set("camera.fov-y-deg", key.fovYDeg);
    document.set("camera.focus", key.focus);
    if (path->aperture > 0) document.set("camera.aperture", path->aperture);
}

Document makeDocument(std::shared_ptr<const Scene> scene, const SceneOptions& options, MessageLog& log) {
    Document document(std::move(scene));
    for (const auto& [id, text, option] : options.values) document.setText(id, text, option);
    warnOfIdle(document, options, log);
    return document;
}

}  // namespace lumi
