#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>

#include "app/commands.h"
#include "base/error.h"
#include "base/files.h"
#include "base/memory.h"
#include "params/json_text.h"
#include "scene/gltf/choices.h"
#include "scene/light_body.h"
#include "scene/material_textures.h"
#include "scene/posed_scene.h"
#include "session/signals_check.h"

namespace lumi {
using nlohmann::json;
namespace {

const char* lightTypeName(LightType type) {
    static const char* names[] = {"point", "spot", "directional", "rectangle", "disk", "sphere"};
    return names[static_cast<int>(type)];
}

int64_t meshCount(const Scene& scene) {
    std::set<const Mesh*> meshes;
    for (const Instance& instance : scene.instances) meshes.insert(instance.mesh.get());
    return static_cast<int64_t>(meshes.size());
}

int64_t emittingMaterials(const Scene& scene) {
    int64_t count = 0;
    for (const Material& material : scene.materials) count += material.emits();
    return count;
}

/// What rendering a scene cannot do without, and the most that the process has held so far.
struct SceneMemory {
    uint64_t geometry = 0, textures = 0, acceleration = 0, peak = 0;
    uint64_t sum() const { return geometry + textures + acceleration; }
    double peakToSum() const { return static_cast<double>(peak) / static_cast<double>(std::max<uint64_t>(sum(), 1)); }
};

/// Of a scene that `tracer` has been bound to.
SceneMemory memoryOf(const Scene& scene, const Tracer& tracer) {
    std::set<const TextureImage*> images;
    for (const Material& material : scene.materials)
        for (const auto texture : kMaterialTextures) images.insert((material.*texture).image.get());
    for (const Light& light : scene.lights) images.insert(light.radianceTexture.image.get());
    images.erase(nullptr);
    SceneMemory memory;
    memory.textures = scene.environment.image ? scene.environment.image->bytes() : 0;
    for (const TextureImage* image : images) memory.textures += image->byteCount();
    memory.geometry = scene.byteCount() - memory.textures;
    memory.acceleration = tracer.byteCount();
    memory.peak = peakResidentBytes();
    return memory;
}

json vectorJson(const Vec3& v) { return json::array({v.x, v.y, v.z}); }

/// What of a glTF can be chosen, and what is: "scenes", "variants" and "animations", empty for other files.
void addChoices(const std::filesystem::path& file, const Document& document, json& info) {
    const std::string extension = lowerExtension(file);
    info["scenes"] = info["variants"] = info["animations"] = json::array();
    if (extension != ".gltf" && extension != ".glb") return;
    const gltf::Choices choices = gltf::readChoices(file);
    const SceneChoice& choice = document.sceneChoice();
    const int shown = choice.index >= 0 ? choice.index : choices.defaultScene;
    for (size_t i = 0; i < choices.scenes.size(); ++i)
        info["scenes"].push_back({{"index", i}, {"title", choices.scenes[i]}, {"shown", static_cast<int>(i) == shown}});
    for (const std::string& variant : choices.variants)
        info["variants"].push_back({{"title", variant}, {"shown", variant == choice.variant}});
    std::set<int> played;
    for (const Animation& animation : document.loadedScene()->animations) played.insert(animation.index);
    for (size_t i = 0; i < choices.animations.size(); ++i)
        info["animations"].push_back(
            {{"index", i}, {"title", choices.animations[i]}, {"shown", played.contains(static_cast<int>(i))}});
}

json infoJson(const Scene& scene, const std::filesystem::path& file, const SceneMemory& memory, const MessageLog& log) {
    const Bounds3 bounds = scene.restBounds();
    const std::vector<bool> ofBodies = bodyMaterials(scene);
    json materials = json::array(), lights = json::array(), cameras = json::array(), instances = json::array();
    std::vector<std::string> materialNames, lightNames, cameraNames;
    for (const Material& m : scene.materials) materialNames.push_back(m.name);
    for (const Light& l : scene.lights) lightNames.push_back(l.name);
    for (const SceneCamera& c : scene.cameras) cameraNames.push_back(c.camera.name);
    const std::vector<std::string> materialIds = slugs(materialNames, "material"),
                                   lightIds = slugs(lightNames, "light"), cameraIds = slugs(cameraNames, "camera");
    for (size_t i = 0; i < materialIds.size(); ++i)
        if (!ofBodies[i])
            materials.push_back(
                {{"id", materialIds[i]}, {"title", materialNames[i]}, {"emits", scene.materials[i].emits()}});
    for (size_t i = 0; i < lightIds.size(); ++i)
        lights.push_back(
            {{"id", lightIds[i]}, {"title", lightNames[i]}, {"type", lightTypeName(scene.lights[i].type)}});
    for (size_t i = 0; i < cameraIds.size(); ++i)
        cameras.push_back({{"id", cameraIds[i]},
                           {"title", cameraNames[i]},
                           {"eye", vectorJson(scene.cameras[i].camera.eye)},
                           {"look_at", vectorJson(scene.cameras[i].camera.target)}});
    return {{"title", scene.title},
            {"path", file.string()},
            {"content_digest", scene.contentDigest},
            {"triangles", scene.triangleCount()},
            {"instances", scene.instances.size()},
            {"meshes", meshCount(scene)},
            {"materials", std::move(materials)},
            {"lights", std::move(lights)},
            {"environment", scene.environment.visible()},
            {"cameras", std::move(cameras)},
            {"animated", scene.isAnimated()},
            {"duration_s", scene.duration()},
            {"bounds",
             bounds.empty() ? json() : json{{"min", vectorJson(bounds.lower)}, {"max", vectorJson(bounds.upper)}}},
            {"memory_bytes", scene.byteCount()},
            {"memory",
             {{"geometry_bytes", memory.geometry},
              {"texture_bytes", memory.textures},
              {"acceleration_bytes", memory.acceleration},
              {"sum_bytes", memory.sum()},
              {"peak_to_sum", memory.peakToSum()}}},
            {"peak_memory_bytes", memory.peak},
            {"warnings", log.warnings()}};
}

/// "a, b, c and 7 more", names by their ids.
std::string someOf(const json& things) {
    constexpr size_t shown = 6;
    std::string text;
    for (size_t i = 0; i < std::min(shown, things.size()); ++i)
        text += (i ? ", " : "") + things[i]["id"].get<std::string>();
    if (things.size() > shown) text += fmt::format(" and {} more", things.size() - shown);
    return text;
}

/// `0 "day", 1 (shown) and 7 more`: the second has no name. Those that are shown are listed wherever they stand.
std::string choicesText(const json& things) {
    constexpr size_t kListed = 20;
    std::vector<std::string> texts;
    size_t more = 0;
    for (const json& thing : things) {
        if (texts.size() >= kListed && (!thing["shown"].get<bool>() || texts.size() >= 2 * kListed)) {
            ++more;
            continue;
        }
        const std::string title = thing["title"].get<std::string>();
        std::string text = thing.contains("index") ? std::to_string(thing["index"].get<int>()) : "";
        if (text.empty() || (!title.empty() && title != text)) text += (text.empty() ? "\"" : " \"") + title + '"';
        texts.push_back(text + (thing["shown"].get<bool>() ? " (shown)" : ""));
    }
    return fmt::format("{}{}", fmt::join(texts, ", "), more > 0 ? fmt::format(" and {} more", more) : "");
}

void printInfo(const json& info, const Scene& scene, const SceneMemory& memory) {
    const auto line = [](const char* name, const std::string& text) {
        std::puts(fmt::format("{:<12}{}", name, text).c_str());
    };
    line("scene", info["title"].get<std::string>().empty() ? "(untitled)" : info["title"].get<std::string>());
    line("file", info["path"].get<std::string>());
    line("geometry", fmt::format("{} triangles in {} instances of {} meshes", scene.triangleCount(),
                                 scene.instances.size(), meshCount(scene)));
    if (info["scenes"].size() > 1)
        line("scenes", fmt::format("{}: {}; --set scene.index=N shows another", info["scenes"].size(),
                                   choicesText(info["scenes"])));
    if (!info["variants"].empty())
        line("variants", fmt::format("{}: {}; --set scene.variant=NAME shows one", info["variants"].size(),
                                     choicesText(info["variants"])));
    if (info["animations"].size() > 1)
        line("animations", fmt::format("{}: {}; --set scene.animation=NAME or number plays one alone",
                                       info["animations"].size(), choicesText(info["animations"])));
    line("materials", fmt::format("{}: {}", info["materials"].size(), someOf(info["materials"])));
    std::string lights =
        fmt::format("{}{}{}", scene.lights.size(), scene.lights.empty() ? "" : ": ", someOf(info["lights"]));
    if (const int64_t emitting = emittingMaterials(scene)) lights += fmt::format("; {} emitting materials", emitting);
    if (scene.environment.visible())
        lights += "; sky" + (scene.environment.file.empty() ? std::string() : " " + scene.environment.file);
    line("lights", lights);
    line("cameras", fmt::format("{}: {}", scene.cameras.size(), someOf(info["cameras"])));
    line("animation", scene.isAnimated() ? fmt::format("{:g} s", scene.duration()) : "none");
    const Bounds3 bounds = scene.restBounds();
    if (!bounds.empty())
        line("bounds",
             fmt::format("{:.3g} x {:.3g} x {:.3g} m, from ({:.3g}, {:.3g}, {:.3g}) to ({:.3g}, {:.3g}, {:.3g})",
                         bounds.size().x, bounds.size().y, bounds.size().z, bounds.lower.x, bounds.lower.y,
                         bounds.lower.z, bounds.upper.x, bounds.upper.y, bounds.upper.z));
    // Beside a small scene the peak is the program's own.
    constexpr uint64_t kSmall = uint64_t(64) << 20;
    line("memory", fmt::format("{}: geometry {}, textures {}, acceleration structure and lights {}; peak {}{}",
                               formatBytes(memory.sum()), formatBytes(memory.geometry), formatBytes(memory.textures),
                               formatBytes(memory.acceleration), formatBytes(memory.peak),
                               memory.sum() < kSmall ? "" : fmt::format(", {:.2f} of it", memory.peakToSum())));
    line("warnings", info["warnings"].empty() ? "none" : std::to_string(info["warnings"].size()));
    for (const json& warning : info["warnings"]) std::puts(("  " + warning.get<std::string>()).c_str());
}

json checksJson(const std::vector<FrameCheck>& checks) {
    json all = json::array();
    for (const FrameCheck& frame : checks)
        for (const ContractFinding& finding : frame.findings)
            all.push_back({{"rule", finding.rule},
                           {"frame", frame.frame},
                           {"holds", finding.holds()},
                           {"violations", finding.violations},
                           {"checked", finding.checked},
                           {"worst_pixel", {finding.worst.x, finding.worst.y}},
                           {"worst_value", finding.value},
                           {"limit", finding.limit},
                           {"unit", finding.unit}});
    return all;
}

void printChecks(const std::vector<FrameCheck>& checks) {
    for (const FrameCheck& frame : checks) {
        std::puts(fmt::format("{:<12}{}", fmt::format("check {}", frame.frame), frame.what).c_str());
        for (const ContractFinding& finding : frame.findings)
            std::puts(fmt::format("  {:<8}{}",
                                  !finding.holds()      ? "BROKEN"
                                  : finding.checked > 0 ? "good"
                                                        : "-",
                                  finding.text())
                          .c_str());
    }
}

}  // namespace

int runInfo(const SceneOptions& options, bool check, const std::filesystem::path& writeCameraPath,
            const MachineOptions& machine, MessageLog& log, std::stop_token stop) {
    const std::filesystem::path file = findScene(options.scene);
    const auto pollStop = [&] {
        if (stop.stop_requested()) throw Error(ErrorKind::Interrupted, {"interrupted", "", "", ""});
    };
    const auto scene = openScene(file, options, log, stop);
    pollStop();
    const Document document = makeDocument(scene, options, log);
    const auto posed = poseScene(document.scene(), {0, 0, 0}, nullptr, stop);
    Tracer tracer;
    tracer.bind(posed, stop);
    pollStop();
    const SceneMemory memory = memoryOf(*scene, tracer);
    std::vector<FrameCheck> checks;
    if (check) checks = checkFrames(document, tracer, stop, stop);
    if (!writeCameraPath.empty())
        writeFileAtomically(writeCameraPath,
                            formatCameraPath(cameraPathOf(*scene, document.cameraIndex(), document.render().fps),
                                             cameraPathFormatOf(writeCameraPath)));
    json info = infoJson(*scene, file, memory, log);
    addChoices(file, document, info);
    if (check) info["checks"] = checksJson(checks);
    if (machine.json) std::puts(jsonText(info, 2).c_str());
    else printInfo(info, *scene, memory);
    if (check && !machine.json) printChecks(checks);
    return std::all_of(checks.begin(), checks.end(), [](const FrameCheck& frame) { return frame.holds(); }) ? 0 : 1;
}

}  // namespace lumi
