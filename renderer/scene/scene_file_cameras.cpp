#include <fmt/format.h>

#include <utility>

#include "base/error.h"
#include "scene/scene_file_parts.h"

namespace lumi {
namespace {

/// What a camera's key may change.
const std::set<std::string> kKeyIds{"eye", "look-at", "fov-y-deg", "focus"};

void readCameraKeys(SceneFileContext& context, ObjectReader& reader, SceneCamera& camera) {
    const JsonValue* list = reader.find("keys");
    if (!list) return;
    if (!list->isArray()) refuseValue(context.tree, *list, "keys", "an array");
    // A key says what changes; the rest stays as the key before it left it.
    Camera moving = camera.camera;
    for (const JsonValue& item : list->items) {
        ObjectReader key(context.tree, item, "keys");
        const float time =
            readKeyTime(key, camera.keys.empty() ? std::nullopt : std::optional(camera.keys.back().time));
        key.parameters([&](ParameterVisitor& v) { moving.describe(v); }, kKeyIds);
        key.finish();
        if (moving.eye == moving.target)
            key.fail(item.at, fmt::format("camera \"{}\" looks at its own eye", reader.name()));
        camera.keys.push_back({time, moving.eye, moving.target, moving.fovYDeg, moving.focus});
    }
}

void readCamera(SceneFileContext& context, const JsonMember& member) {
    ObjectReader reader(context.tree, member.value, member.key);
    SceneCamera camera;
    camera.camera.name = member.key;
    reader.parameters([&](ParameterVisitor& v) { camera.camera.describe(v); });
    if (camera.camera.eye == camera.camera.target)
        reader.fail(member.value.at, fmt::format("camera \"{}\" looks at its own eye", member.key));
    if (glm::length(camera.camera.up) == 0)
        refuseValue(context.tree, *reader.find("up"), "up", "a vector that is not zero");
    // Without a focus of its own a camera is sharp where it looks.
    if (!reader.find("focus")) camera.camera.focus = glm::distance(camera.camera.eye, camera.camera.target);
    camera.interpolation = readInterpolation(reader, Interpolation::CatmullRom);
    readCameraKeys(context, reader, camera);
    reader.finish();
    context.scene.cameras.push_back(std::move(camera));
}

/// A value of "set" as text, as it would stand on the command line.
std::string settingText(SceneFileContext& context, const JsonMember& member) {
    const JsonValue& value = member.value;
    if (value.isString()) return value.text;
    if (value.isNumber() || value.type == JsonValue::Type::Boolean) return value.shown();
    if (value.isArray() && value.items.size() == 3) {
        const Vec3 v = readVector(context.tree, value, member.key);
        return formatParameter(v);
    }
    refuseValue(context.tree, value, member.key, "a number, true or false, text or three numbers");
}

}  // namespace

void describeRender(RenderDefaults& render, ParameterVisitor& v) {
    v.integer(
        "width", render.size.width,
        {.label = "Width", .min = 1, .max = 16384, .unit = "px", .help = "Width of the image.", .redo = Redo::Samples});
    v.integer("height", render.size.height,
              {.label = "Height",
               .min = 1,
               .max = 16384,
               .unit = "px",
               .help = "Height of the image.",
               .redo = Redo::Samples});
    v.number("fps", render.fps,
             {.label = "Frames per second",
              .min = 0.1,
              .max = 1000,
              .help = "The time of frame f is f / fps seconds.",
              .redo = Redo::Samples});
    v.number("exposure", render.exposureEv,
             {.label = "Exposure",
              .min = -20,
              .max = 20,
              .unit = "EV",
              .help = "Exposure of views and of metrics.",
              .redo = Redo::Display});
    v.text("module", render.module,
           {.label = "Module", .help = "The module instance that makes the image.", .redo = Redo::Filter});
}

void readCameras(SceneFileContext& context, const JsonValue* section) {
    for (const JsonMember& member : membersOf(context, section, "cameras")) readCamera(context, member);
}

void readRender(SceneFileContext& context, const JsonValue* section) {
    if (!section) return;
    ObjectReader reader(context.tree, *section, "render");
    RenderDefaults& render = context.scene.render;
    const JsonValue* set = reader.find("set");
    reader.parameters([&](ParameterVisitor& v) { describeRender(render, v); });
    reader.finish();
    for (const JsonMember& member : membersOf(context, set, "set")) {
        // These choose among what the one glTF file holds that a person opens.
        if (member.key.starts_with("scene."))
            throwBadInput({fmt::format("\"{}\" does nothing to a scene file", member.key),
                           context.tree.where(member.at), "\"scene\", \"variant\" or \"animation\" of an asset", ""});
        render.set.emplace_back(member.key, settingText(context, member));
    }
}

}  // namespace lumi
