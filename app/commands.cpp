#include "app/commands.h"

#include <cstdio>

#include "base/error.h"
#include "base/isa.h"
#include "base/memory.h"
#include "base/parallel.h"

namespace lumi {

void applyMachine(const MachineOptions& machine) {
    if (machine.threads > 0) setThreadCount(machine.threads);
    if (!machine.isa.empty()) setIsa(parseIsa(machine.isa));
    if (!machine.memoryLimit.empty()) setMemoryLimit(parseBytes(machine.memoryLimit));
}

std::shared_ptr<const Scene> openScene(const std::filesystem::path& file, const SceneOptions& options, MessageLog& log,
                                       std::stop_token stop) {
    LoadOptions load;
    load.stop = stop;
    for (const auto& [id, text, option] : options.values) {
        if (id == "scene.variant") load.variant = text;
        if (id != "scene.index") continue;
        try {
            load.sceneIndex = std::stoi(text);
        } catch (const std::exception&) {
            throwUsage({"\"scene.index\" has the wrong type", option, "a whole number", '"' + text + '"'});
        }
    }
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

Document makeDocument(std::shared_ptr<const Scene> scene, const SceneOptions& options) {
    Document document(std::move(scene));
    for (const auto& [id, text, option] : options.values) document.setText(id, text, option);
    return document;
}

}  // namespace lumi
