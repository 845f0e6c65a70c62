#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "params/json.h"
#include "scene/procedural/procedural.h"
#include "scene/scene_file.h"
#include "scene/scene_file_parts.h"
#include "scene/sky.h"

namespace lumi {
namespace {

using Json = nlohmann::ordered_json;

Json text(const char* help) { return {{"type", "string"}, {"description", help}}; }
Json numbers(int count, const char* help) {
    return {{"type", "array"},
            {"items", {{"type", "number"}}},
            {"minItems", count},
            {"maxItems", count},
            {"description", help}};
}
Json closed(Json properties, const char* help) {
    return {{"type", "object"},
            {"description", help},
            {"properties", std::move(properties)},
            {"additionalProperties", false}};
}
Json mapOf(Json entry, const char* help) {
    return {{"type", "object"}, {"description", help}, {"additionalProperties", std::move(entry)}};
}
Json reference(const char* name) { return {{"$ref", std::string("#/$defs/") + name}}; }

void setLimits(Json& schema, const ParameterInfo& info) {
    if (std::isfinite(info.min)) schema["minimum"] = info.min;
    if (std::isfinite(info.max)) schema["maximum"] = info.max;
}

Json parameterSchema(const ParameterInfo& info) {
    Json schema;
    std::string help = info.help;
    if (!info.unit.empty()) help += " Unit: " + info.unit + ".";
    schema["description"] = help;
    switch (info.type) {
        case ParameterType::Number:
            schema["type"] = "number";
            setLimits(schema, info);
            break;
        case ParameterType::Integer:
            schema["type"] = "integer";
            setLimits(schema, info);
            break;
        case ParameterType::Toggle: schema["type"] = "boolean"; break;
        case ParameterType::Choice: schema["enum"] = info.options; break;
        case ParameterType::Text: schema["type"] = "string"; break;
        case ParameterType::Vector:
        case ParameterType::Colour: {
            Json channel = {{"type", "number"}};
            setLimits(channel, info);
            schema["type"] = info.type == ParameterType::Colour ? Json{"number", "array"} : Json("array");
            schema["items"] = channel, schema["minItems"] = 3, schema["maxItems"] = 3;
            if (info.type == ParameterType::Colour) setLimits(schema, info);
            break;
        }
    }
    if (std::holds_alternative<float>(info.value) && !std::isfinite(std::get<float>(info.value))) return schema;
    schema["default"] = toJson(info.value);
    return schema;
}

/// Properties for all that `describe` declares; `size` where width and height are declared.
Json properties(const Describe& describe, const std::set<std::string>& only = {},
                const std::set<std::string>& except = {}) {
    Json all = Json::object();
    int sides = 0;
    for (const ParameterInfo& info : listParameters(describe)) {
        if ((!only.empty() && !only.contains(info.id)) || except.contains(info.id)) continue;
        all[info.id] = parameterSchema(info);
        sides += info.id == "width" || info.id == "height" || info.id == "depth";
    }
    if (sides >= 2) all["size"] = numbers(sides, sides == 2 ? "Width and height." : "Width, height and depth.");
    return all;
}

Json interpolation() { return {{"enum", {"step", "linear", "catmull-rom"}}, {"description", "Between keys."}}; }

/// Placement of instances and lights, and the same with a time for their keys.
Json placement(bool scale, bool look) {
    Json all;
    all["translate"] = numbers(3, "Metres.");
    all["rotate-deg"] = numbers(3, "Degrees about the fixed axes X, then Y, then Z.");
    if (scale)
        all["scale"] = {{"description", "One factor, or one for each axis; not zero."},
                        {"anyOf", {Json{{"type", "number"}}, numbers(3, "For X, Y and Z.")}}};
    if (look) {
        all["look-at"] = numbers(3, "The point that the light's axis (-Z) goes through.");
        all["direction"] = numbers(3, "Where the light's axis (-Z) points.");
    }
    return all;
}

void addKeys(Json& all, Json key, const char* help) {
    key["time"] = {{"type", "number"}, {"minimum", 0}, {"description", "Seconds; ascending."}};
    Json item = closed(std::move(key), "What holds at this time; what is not mentioned is not moved by this key.");
    item["required"] = {"time"};
    all["keys"] = {{"type", "array"}, {"items", std::move(item)}, {"description", help}};
    all["interpolation"] = interpolation();
}

Json assetSchema() {
    Json kinds = Json::array();
    kinds.push_back(closed(
        {{"gltf", text("A .gltf or .glb file, relative to this file, or assets: and a path under $LUMISCOPE_ASSETS.")},
         {"scene", {{"type", "integer"}, {"minimum", 0}, {"description", "Which of its scenes."}}},
         {"variant", text("Which of its material variants.")},
         {"animation", text("Which of its animations plays, by name or number; without, each that moves nothing that "
                            "an earlier one moves.")}},
        "A glTF 2.0 asset."));
    Subdivision subdivision;
    Json obj = {{"obj", text("An .obj file, relative to this file, or assets: and a path under $LUMISCOPE_ASSETS.")}};
    obj.update(properties([&](ParameterVisitor& v) { subdivision.describe(v); }));
    kinds.push_back(closed(std::move(obj), "A Wavefront OBJ asset, or the cage of a subdivision surface."));
    for (Json& kind : kinds) kind["required"] = {kind["properties"].begin().key()};
    for (const ProceduralEntry& entry : proceduralCatalog()) {
        const auto generator = entry.make();
        Json shape = properties([&](ParameterVisitor& v) { generator->describe(v); });
        Json kind = closed({{entry.name, closed(std::move(shape), entry.help)}}, entry.help);
        kind["required"] = {entry.name};
        kinds.push_back(std::move(kind));
    }
    return {{"oneOf", std::move(kinds)}};
}

Json textureSchema() {
    TexturePlacement placement;
    Json all = {
        {"file",
         text("A PNG, JPEG, BMP or TGA file, relative to this file, or assets: and a path under $LUMISCOPE_ASSETS.")}};
    for (const ProceduralTextureEntry& entry : proceduralTextureCatalog()) {
        const auto generator = entry.make();
        all[entry.name] = closed(properties([&](ParameterVisitor& v) { generator->describe(v); }), entry.help);
    }
    all["scale"] = {{"description", "Repetitions for each unit of uv."},
                    {"anyOf", {Json{{"type", "number"}}, numbers(2, "Along u and v.")}}};
    all["offset"] = numbers(2, "Shift along u and v.");
    all.update(properties([&](ParameterVisitor& v) { placement.describe(v); }, {},
                          {"scale-u", "scale-v", "offset-u", "offset-v"}));
    return {{"anyOf", {text("A PNG, JPEG, BMP or TGA file."), closed(std::move(all), "An image or a generated one.")}}};
}

Json materialSchema() {
    Material material;
    Json all = properties([&](ParameterVisitor& v) { material.describe(v); });
    for (const TextureKey& key : kTextureKeys) {
        all[key.key] = reference("texture");
        all[key.key]["description"] = key.help;
    }
    return closed(std::move(all), "A metallic-roughness material.");
}

Json instanceSchema() {
    Json all;
    all["name"] = text("Unique; by default the asset's name and a number.");
    all["asset"] = text("An entry of assets; without one the instance is a group that others name as parent.");
    all["parent"] = text("Another instance, whose motion this one follows.");
    all["material"] = text("An entry of materials: fills every slot of the asset.");
    all["materials"] = mapOf(text("An entry of materials."), "Fills slots of the asset by name.");
    all.update(placement(true, false));
    all["loop"] = {{"type", "boolean"}, {"default", true}, {"description", "Motion starts again after the last key."}};
    addKeys(all, placement(true, false), "Motion.");
    return closed(std::move(all), "A placed asset.");
}

Json lightSchema() {
    Json kinds = Json::array();
    for (const LightKind& kind : kLightKinds) {
        Light light;
        light.type = kind.type;
        const Describe describe = [&](ParameterVisitor& v) { light.describe(v); };
        const std::set<std::string> ids = activeIds(light, false);
        Json all;
        all[kind.name] = closed(ids.empty() ? Json::object() : properties(describe, ids), "What the light is.");
        all.update(properties(describe, activeIds(light, true)));
        if (light.type == LightType::Rectangle || light.type == LightType::Disk) {
            all[kRadianceTexture.key] = reference("texture");
            all[kRadianceTexture.key]["description"] = kRadianceTexture.help;
        }
        all["parent"] = text("An instance, whose motion the light follows.");
        all.update(placement(false, true));
        all["loop"] = {
            {"type", "boolean"}, {"default", true}, {"description", "Motion starts again after the last key."}};
        addKeys(all, placement(false, true), "Motion.");
        Json schema = closed(std::move(all), "A light; it shines along its -Z axis.");
        schema["required"] = {kind.name};
        kinds.push_back(std::move(schema));
    }
    return {{"oneOf", std::move(kinds)}};
}

Json environmentSchema() {
    Environment environment;
    Sky sky;
    Json all = {{"file", text("An equirectangular .hdr or .exr, relative to this file, or assets: and a path under "
                              "$LUMISCOPE_ASSETS; its centre is -Z.")}};
    all["sky"] = closed(properties([&](ParameterVisitor& v) { sky.describe(v); }), "A built-in daylight sky.");
    all.update(properties([&](ParameterVisitor& v) { environment.describe(v); }));
    return closed(std::move(all), "Light from infinitely far.");
}

Json cameraSchema() {
    Camera camera;
    const Describe describe = [&](ParameterVisitor& v) { camera.describe(v); };
    Json all = properties(describe);
    addKeys(all, properties(describe, {"eye", "look-at", "fov-y-deg", "focus"}), "A camera path.");
    return closed(std::move(all), "A camera. Without a focus it is sharp where it looks.");
}

Json renderSchema() {
    RenderDefaults render;
    Json all = properties([&](ParameterVisitor& v) { describeRender(render, v); });
    all["set"] = mapOf({{"type", {"number", "boolean", "string", "array"}}}, "Parameter ids and their values.");
    return closed(std::move(all), "How the scene is rendered when nobody says otherwise.");
}

}  // namespace

std::string sceneFileSchema() {
    Json top;
    top["$schema"] = text("This schema.");
    top["version"] = {{"const", 1}};
    top["title"] = text("Shown in lists.");
    top["assets"] = mapOf(assetSchema(), "What can be placed, by name.");
    top["materials"] = mapOf(reference("material"), "Materials by name.");
    top["instances"] = {{"type", "array"}, {"items", instanceSchema()}, {"description", "What stands in the scene."}};
    top["lights"] = mapOf(lightSchema(), "Lights by name.");
    top["environment"] = environmentSchema();
    top["cameras"] = mapOf(cameraSchema(), "Cameras by name; the first is the default.");
    top["render"] = renderSchema();

    Json schema;
    schema["$schema"] = "https://json-schema.org/draft/2020-12/schema";
    schema["title"] = "Lumiscope scene";
    schema.update(closed(std::move(top), "A scene file. Lengths in metres, angles in degrees, +Y is up."));
    schema["required"] = {"version"};
    schema["$defs"]["material"] = materialSchema();
    schema["$defs"]["texture"] = textureSchema();
    return schema.dump(2) + "\n";
}

}  // namespace lumi
