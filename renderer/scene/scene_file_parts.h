#pragma once
#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "scene/asset_folder.h"
#include "scene/asset_placer.h"
#include "scene/json_reader.h"
#include "scene/load.h"

// The sections of a scene file, one function each; scene_file.cpp calls them in this order.
namespace lumi {

/// What the sections share while a file is read.
struct SceneFileContext {
    const JsonTree& tree;
    std::filesystem::path folder;
    MessageLog& log;
    const LoadOptions& options;
    Scene scene;
    std::map<std::string, int> materials;       ///< index into scene.materials
    std::map<std::string, PlacedAsset> assets;  ///< loaded
    std::map<std::string, int> instanceNodes;   ///< index into scene.nodes
    std::string digests;                        ///< of every file that was read, in order
    /// What makes two images the same: file, generator with its parameters, sRGB, mip levels.
    using ImageKey = std::tuple<std::string, std::string, bool, bool>;
    std::map<ImageKey, std::shared_ptr<const TextureImage>> images = {};  ///< read or generated so far

    /// `name` relative to the scene file's folder, or an asset (scene/asset_folder.h). Throws what findAsset() throws.
    std::filesystem::path resolve(const std::string& name) const {
        return isAssetName(name) ? findAsset(name) : folder / name;
    }
    void report(float fraction, const std::string& step) const {
        if (options.progress) options.progress(fraction, step);
    }
    /// Throws Error(Interrupted) once a stop was requested.
    void checkStop() const;
};

void readMaterials(SceneFileContext&, const JsonValue* section);
void readAssets(SceneFileContext&, const JsonValue* section, const JsonValue* instances);
void readInstances(SceneFileContext&, const JsonValue* section);
void readLights(SceneFileContext&, const JsonValue* section);
void readEnvironment(SceneFileContext&, const JsonValue* section);
void readCameras(SceneFileContext&, const JsonValue* section);
void readRender(SceneFileContext&, const JsonValue* section);

/// The kinds of light, by the key that says what a light is.
struct LightKind {
    const char* name;
    LightType type;
};
extern const std::array<LightKind, 6> kLightKinds;

/// Ids that matter for a light of this type: what it emits ("radiance", "power", ...) or what it is ("radius", ...).
std::set<std::string> activeIds(Light light, bool emission);

/// Parameters of "render" that have limits of their own.
void describeRender(RenderDefaults& render, ParameterVisitor& v);

/// The textures that a material can name: its key, whether the image is a colour, and where it goes.
struct TextureKey {
    const char* key;
    bool srgb;
    Texture Material::*member;
    const char* help;
};
extern const std::vector<TextureKey> kTextureKeys;
/// The flat lights' image, which no material has.
extern const TextureKey kRadianceTexture;

/// Loads or generates one texture by itself.
Texture readTexture(SceneFileContext&, const JsonValue& value, const TextureKey& key);

/// Placement of a texture on a surface: scale, offset, rotate-deg, wrap, filter, uv-set.
struct TexturePlacement {
    Vec2 offset{0}, scale{1};
    float rotateDeg = 0;
    int uvSet = 0;
    Wrap wrap = Wrap::Repeat;
    TextureFilter filter = TextureFilter::Linear;
    bool mipmaps = true;
    void describe(ParameterVisitor& v);
};

/// "translate", "rotate-deg", "scale", "look-at", "direction" and "keys" of an object that asks for them.
struct PlacementKeys {
    bool scale = true;  ///< instances
    bool look = false;  ///< lights: look-at and direction
};

/// Reads a placement into `node` and, if it has keys, adds an animation to the scene. The node is `nodeIndex`.
void readPlacement(SceneFileContext&, ObjectReader& reader, int nodeIndex, PlacementKeys keys);

/// Rotation from degrees about the fixed axes X, then Y, then Z.
Quat rotationFromDegrees(const Vec3& degrees);

/// Reads "interpolation" (step, linear, catmull-rom), or gives `fallback`.
Interpolation readInterpolation(ObjectReader& reader, Interpolation fallback);

/// Times of "keys": each a number, at least two keys not required, strictly ascending from 0 or later.
float readKeyTime(ObjectReader& key, std::optional<float> previous);

/// Members of an object section, or none when it is absent. Refuses other types.
const std::vector<JsonMember>& membersOf(const SceneFileContext&, const JsonValue* section, const std::string& name);

/// Names of a map, for messages.
template <class Map>
std::vector<std::string> namesOf(const Map& map) {
    std::vector<std::string> names;
    for (const auto& entry : map) names.push_back(entry.first);
    return names;
}

}  // namespace lumi
