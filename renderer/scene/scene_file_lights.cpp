#include <fmt/format.h>

#include <array>
#include <set>
#include <utility>

#include "base/error.h"
#include "base/files.h"
#include "image/hdr.h"
#include "scene/scene_file_parts.h"
#include "scene/sky.h"

namespace lumi {

const std::array<LightKind, 6> kLightKinds{{
    {"rectangle", LightType::Rectangle},
    {"disk", LightType::Disk},
    {"sphere", LightType::Sphere},
    {"point", LightType::Point},
    {"spot", LightType::Spot},
    {"directional", LightType::Directional},
}};

const std::set<std::string> kEmissionIds{"power", "intensity", "irradiance", "radiance"};

std::set<std::string> activeIds(Light light, bool emission) {
    std::set<std::string> ids;
    for (const ParameterInfo& info : listParameters([&](ParameterVisitor& v) { light.describe(v); }))
        if (info.active && kEmissionIds.contains(info.id) == emission) ids.insert(info.id);
    return ids;
}

namespace {

void readLight(SceneFileContext& context, const JsonMember& member) {
    ObjectReader reader(context.tree, member.value, member.key);
    Light light;
    light.name = member.key;
    const JsonValue* shape = nullptr;
    for (const LightKind& kind : kLightKinds) {
        const JsonValue* value = reader.find(kind.name);
        if (!value) continue;
        if (shape) reader.fail(value->at, fmt::format("light \"{}\" has two kinds", member.key));
        shape = value;
        light.type = kind.type;
    }
    const auto describe = [&](ParameterVisitor& v) { light.describe(v); };
    if (shape) {
        // What the light is stands inside, what it emits beside: {"sphere": {"radius": 0.1}, "radiance": [5, 5, 5]}.
        ObjectReader inner(context.tree, *shape, member.key);
        // A kind without numbers of its own (a point light's range apart) is written as an empty object.
        inner.parameters(describe, activeIds(light, false), kEmissionIds);
        inner.finish();
        reader.parameters(describe, activeIds(light, true));
        if (light.type == LightType::Rectangle || light.type == LightType::Disk)
            if (const JsonValue* texture = reader.find(kRadianceTexture.key))
                light.radianceTexture = readTexture(context, *texture, kRadianceTexture);
        if (light.type == LightType::Spot && light.innerConeDeg > light.outerConeDeg)
            refuseValue(context.tree, *shape, "spot", "an inner cone within the outer");
    }

    Node node;
    node.name = member.key;
    if (const JsonValue* parent = reader.find("parent")) {
        const std::string name = readText(context.tree, *parent, "parent");
        const auto found = context.instanceNodes.find(name);
        if (found == context.instanceNodes.end())
            refuseName(context.tree, parent->at, "instance", name, namesOf(context.instanceNodes));
        node.parent = found->second;
    }
    light.node = static_cast<int>(context.scene.nodes.size());
    context.scene.nodes.push_back(std::move(node));
    readPlacement(context, reader, light.node, {.scale = false, .look = true});
    reader.finish();
    if (!shape) {
        std::vector<std::string> kinds;
        for (const LightKind& kind : kLightKinds) kinds.emplace_back(kind.name);
        reader.fail(member.value.at, fmt::format("light \"{}\" has no kind", member.key),
                    "one of " + quotedList(kinds));
    }
    context.scene.lights.push_back(std::move(light));
}

void readEnvironmentFile(SceneFileContext& context, const JsonValue& value, Environment& environment) {
    const std::string name = readText(context.tree, value, "file");
    try {
        const std::filesystem::path path = context.resolve(name);
        const std::vector<uint8_t> bytes = readFile(path);
        context.digests += digest(bytes);
        environment.image = std::make_shared<const Image>(loadImage(path));
        environment.file = path.string();
    } catch (const Error& error) {
        throw Error(error.kind(),
                    {fmt::format("\"environment\": {}", error.what()), context.tree.where(value.at), "", ""});
    }
}

}  // namespace

void readLights(SceneFileContext& context, const JsonValue* section) {
    for (const JsonMember& member : membersOf(context, section, "lights")) readLight(context, member);
}

void readEnvironment(SceneFileContext& context, const JsonValue* section) {
    if (!section) return;
    ObjectReader reader(context.tree, *section, "environment");
    Environment& environment = context.scene.environment;
    const JsonValue* file = reader.find("file");
    const JsonValue* sky = reader.find("sky");
    if (file && sky) reader.fail(sky->at, "\"environment\" has both \"file\" and \"sky\"");
    if (file) {
        readEnvironmentFile(context, *file, environment);
    } else if (sky) {
        Sky settings;
        ObjectReader inner(context.tree, *sky, "sky");
        inner.parameters([&](ParameterVisitor& v) { settings.describe(v); });
        inner.finish();
        environment.image = std::make_shared<const Image>(settings.build());
    }
    const bool hasImage = environment.image != nullptr;
    reader.parameters([&](ParameterVisitor& v) { environment.describe(v); }, {},
                      hasImage ? std::set<std::string>{"constant"} : std::set<std::string>{});
    reader.finish();
}

}  // namespace lumi
