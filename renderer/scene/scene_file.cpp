#include "scene/scene_file.h"

#include <fmt/format.h>

#include "base/error.h"
#include "base/files.h"
#include "scene/light_body.h"
#include "scene/scene_file_parts.h"

namespace lumi {
namespace fs = std::filesystem;
namespace {

void readVersion(ObjectReader& top) {
    const JsonValue& version = top.need("version");
    if (!version.isNumber() || version.number != 1) refuseValue(top.tree(), version, "version", "1");
}

}  // namespace

void SceneFileContext::checkStop() const {
    if (options.stop.stop_requested()) throw Error(ErrorKind::Interrupted, {"loading was stopped", tree.file, "", ""});
}

const std::vector<JsonMember>& membersOf(const SceneFileContext& context, const JsonValue* section,
                                         const std::string& name) {
    static const std::vector<JsonMember> none;
    if (!section) return none;
    if (!section->isObject()) refuseValue(context.tree, *section, name, "an object");
    return section->members;
}

Scene parseSceneFile(const std::string& text, const std::string& file, const fs::path& folder, MessageLog& log,
                     const LoadOptions& options) {
    const JsonTree tree = parseJsonTree(text, file);
    if (!tree.root.isObject())
        throwBadInput({"is not a scene file", tree.where(tree.root.at), "a JSON object", tree.root.shown()});
    SceneFileContext context{tree, folder, log, options, {}, {}, {}, {}, {}};
    context.digests = digest({reinterpret_cast<const uint8_t*>(text.data()), text.size()});

    ObjectReader top(tree, tree.root, "scene");
    readVersion(top);
    context.scene.title = top.text("title").value_or("");
    const JsonValue* materials = top.find("materials");
    const JsonValue* assets = top.find("assets");
    const JsonValue* instances = top.find("instances");
    const JsonValue* lights = top.find("lights");
    const JsonValue* environment = top.find("environment");
    const JsonValue* cameras = top.find("cameras");
    const JsonValue* render = top.find("render");
    top.find("$schema");
    top.finish();

    readCameras(context, cameras);
    readRender(context, render);
    readMaterials(context, materials);
    readAssets(context, assets, instances);
    readInstances(context, instances);
    readLights(context, lights);
    readEnvironment(context, environment);
    addLightBodies(context.scene);

    Scene& scene = context.scene;
    if (scene.materials.empty()) {
        scene.materials.emplace_back();
        scene.materials.back().name = "default";
    }
    scene.path = file;
    scene.contentDigest = digest({reinterpret_cast<const uint8_t*>(context.digests.data()), context.digests.size()});
    return std::move(scene);
}

Scene loadSceneFile(const fs::path& path, MessageLog& log, const LoadOptions& options) {
    const std::string text = readTextFile(path, kMaxSceneFileBytes);
    return parseSceneFile(text, path.string(), path.parent_path(), log, options);
}

std::string sceneFileTitle(const fs::path& path) {
    try {
        const JsonTree tree = parseJsonTree(readTextFile(path, kMaxSceneFileBytes), path.string());
        for (const JsonMember& member : tree.root.members)
            if (member.key == "title" && member.value.isString()) return member.value.text;
    } catch (const Error&) {
        // A list of scenes shows broken files too; opening one says what is wrong with it.
    }
    return {};
}

}  // namespace lumi
