#include "scene/gltf/structure_table.h"

namespace lumi::gltf {
namespace {

constexpr Rule object(std::string_view path) { return {path, Kind::Object, {}, Need::Required}; }
constexpr Rule array(std::string_view path) { return {path, Kind::Array, {}, Need::Required}; }
constexpr Rule text(std::string_view path, Need need = Need::Optional) { return {path, Kind::Text, {}, need}; }
constexpr Rule number(std::string_view path) { return {path, Kind::Number}; }
constexpr Rule numbers(std::string_view path, uint64_t count) {
    return {path, Kind::Numbers, {}, Need::Optional, 0, count};
}
constexpr Rule word(std::string_view path, std::string_view words) { return {path, Kind::Word, words, Need::Required}; }
constexpr Rule whole(std::string_view path, uint64_t least = 0, uint64_t most = kAny, uint64_t step = 1) {
    return {path, Kind::Whole, {}, Need::Optional, least, most, step};
}
constexpr Rule code(std::string_view path, std::string_view codes) { return {path, Kind::Code, codes, Need::Required}; }
constexpr Rule index(std::string_view path, std::string_view section) { return {path, Kind::Index, section}; }
constexpr Rule typed(std::string_view path, std::string_view types) { return {path, Kind::Typed, types}; }
constexpr Rule required(Rule rule) {
    rule.need = Need::Required;
    return rule;
}
constexpr Rule orMinusOne(Rule rule) {
    rule.orMinusOne = true;
    return rule;
}

constexpr Rule kAsset[] = {object("asset"), text("asset/version", Need::Required)};

constexpr Rule kForm[] = {
    object("accessors/[]"),
    object("animations/[]"),
    object("bufferViews/[]"),
    object("buffers/[]"),
    object("cameras/[]"),
    word("cameras/[]/type", "perspective|orthographic"),
    object("images/[]"),
    object("materials/[]"),
    object("meshes/[]"),
    object("nodes/[]"),
    object("samplers/[]"),
    object("scenes/[]"),
    object("skins/[]"),
    object("textures/[]"),
    object("extensions/KHR_lights_punctual/lights/[]"),
    text("extensions/KHR_lights_punctual/lights/[]/type", Need::Required),
};

constexpr Rule kRules[] = {
    required(whole("buffers/[]/byteLength", 1)),
    text("buffers/[]/uri"),
    required(index("bufferViews/[]/buffer", "buffers")),
    whole("bufferViews/[]/byteOffset"),
    required(whole("bufferViews/[]/byteLength")),
    whole("bufferViews/[]/byteStride", 0, 252, 4),
    required(index("bufferViews/[]/extensions/EXT_meshopt_compression/buffer", "buffers")),
    whole("bufferViews/[]/extensions/EXT_meshopt_compression/byteOffset", 0, kMostInt),
    required(whole("bufferViews/[]/extensions/EXT_meshopt_compression/byteLength", 1, kMostInt)),
    required(whole("bufferViews/[]/extensions/EXT_meshopt_compression/byteStride", 1, 256)),
    required(whole("bufferViews/[]/extensions/EXT_meshopt_compression/count", 0, kMostInt)),

    index("accessors/[]/bufferView", "bufferViews"),
    whole("accessors/[]/byteOffset"),
    code("accessors/[]/componentType", "5120|5121|5122|5123|5125|5126"),
    required(whole("accessors/[]/count")),
    word("accessors/[]/type", "SCALAR|VEC2|VEC3|VEC4|MAT2|MAT3|MAT4"),
    required(whole("accessors/[]/sparse/count", 0, kMostInt)),
    object("accessors/[]/sparse/indices"),
    required(index("accessors/[]/sparse/indices/bufferView", "bufferViews")),
    whole("accessors/[]/sparse/indices/byteOffset", 0, kMostInt),
    required(whole("accessors/[]/sparse/indices/componentType", 0, kMostInt)),
    object("accessors/[]/sparse/values"),
    required(index("accessors/[]/sparse/values/bufferView", "bufferViews")),
    whole("accessors/[]/sparse/values/byteOffset", 0, kMostInt),

    text("images/[]/uri"),
    index("images/[]/bufferView", "bufferViews"),
    orMinusOne(whole("samplers/[]/magFilter", 0, kMostInt)),
    orMinusOne(whole("samplers/[]/minFilter", 0, kMostInt)),
    whole("samplers/[]/wrapS", 0, kMostInt),
    whole("samplers/[]/wrapT", 0, kMostInt),
    index("textures/[]/source", "images"),
    index("textures/[]/sampler", "samplers"),

    object("meshes/[]/primitives/[]/attributes"),
    index("meshes/[]/primitives/[]/attributes/{}", "accessors"),
    index("meshes/[]/primitives/[]/indices", "accessors"),
    index("meshes/[]/primitives/[]/material", "materials"),
    whole("meshes/[]/primitives/[]/mode", 0, 6),
    index("meshes/[]/primitives/[]/targets/[]/{}", "accessors"),
    required(index("meshes/[]/primitives/[]/extensions/KHR_draco_mesh_compression/bufferView", "bufferViews")),
    required(index("meshes/[]/primitives/[]/extensions/KHR_materials_variants/mappings/[]/material", "materials")),
    required(whole("meshes/[]/primitives/[]/extensions/KHR_materials_variants/mappings/[]/variants/[]", 0, kMostInt)),

    typed("cameras/[]", "perspective|orthographic"),
    required(number("cameras/[]/perspective/yfov")),
    required(number("cameras/[]/perspective/znear")),
    number("cameras/[]/perspective/zfar"),
    required(number("cameras/[]/orthographic/xmag")),
    required(number("cameras/[]/orthographic/ymag")),
    required(number("cameras/[]/orthographic/znear")),
    required(number("cameras/[]/orthographic/zfar")),
    typed("extensions/KHR_lights_punctual/lights/[]", "spot"),

    index("skins/[]/inverseBindMatrices", "accessors"),
    index("skins/[]/skeleton", "nodes"),
    array("skins/[]/joints"),
    required(index("skins/[]/joints/[]", "nodes")),
    index("nodes/[]/mesh", "meshes"),
    index("nodes/[]/skin", "skins"),
    index("nodes/[]/camera", "cameras"),
    required(index("nodes/[]/children/[]", "nodes")),
    numbers("nodes/[]/translation", 3),
    numbers("nodes/[]/rotation", 4),
    numbers("nodes/[]/scale", 3),
    numbers("nodes/[]/matrix", 16),
    index("nodes/[]/extensions/EXT_mesh_gpu_instancing/attributes/{}", "accessors"),
    required(whole("nodes/[]/extensions/KHR_lights_punctual/light", 0, kMostInt)),
    required(index("scenes/[]/nodes/[]", "nodes")),
    index("scene", "scenes"),

    required(index("animations/[]/samplers/[]/input", "accessors")),
    required(index("animations/[]/samplers/[]/output", "accessors")),
    required(whole("animations/[]/channels/[]/sampler", 0, kMostInt)),
    object("animations/[]/channels/[]/target"),
    index("animations/[]/channels/[]/target/node", "nodes"),
};

constexpr std::string_view kTexturePaths[] = {
    "pbrMetallicRoughness/baseColorTexture",
    "pbrMetallicRoughness/metallicRoughnessTexture",
    "normalTexture",
    "occlusionTexture",
    "emissiveTexture",
    "extensions/KHR_materials_anisotropy/anisotropyTexture",
    "extensions/KHR_materials_clearcoat/clearcoatTexture",
    "extensions/KHR_materials_clearcoat/clearcoatRoughnessTexture",
    "extensions/KHR_materials_clearcoat/clearcoatNormalTexture",
    "extensions/KHR_materials_iridescence/iridescenceTexture",
    "extensions/KHR_materials_iridescence/iridescenceThicknessTexture",
    "extensions/KHR_materials_pbrSpecularGlossiness/diffuseTexture",
    "extensions/KHR_materials_pbrSpecularGlossiness/specularGlossinessTexture",
    "extensions/KHR_materials_sheen/sheenColorTexture",
    "extensions/KHR_materials_sheen/sheenRoughnessTexture",
    "extensions/KHR_materials_specular/specularTexture",
    "extensions/KHR_materials_specular/specularColorTexture",
    "extensions/KHR_materials_transmission/transmissionTexture",
};

constexpr Rule kTextureRules[] = {
    {"", Kind::Texture},
    required(index("/index", "textures")),
    orMinusOne(whole("/texCoord", 0, kMostInt)),
    orMinusOne(whole("/extensions/KHR_texture_transform/texCoord", 0, kMostInt)),
};

}  // namespace

std::span<const Rule> assetRules() { return kAsset; }
std::span<const Rule> formRules() { return kForm; }
std::span<const Rule> rules() { return kRules; }
std::span<const std::string_view> texturePaths() { return kTexturePaths; }
std::span<const Rule> textureRules() { return kTextureRules; }

}  // namespace lumi::gltf
