#pragma once
#include <string>
#include <utility>
#include <vector>

#include "image/png.h"
#include "unit/scene/gltf_support.h"

namespace lumi::test {

inline std::string base64(const std::vector<uint8_t>& bytes) {
    static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        uint32_t word = 0;
        for (size_t k = 0; k < 3; ++k) word = word << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
        for (size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? kDigits[word >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

inline std::vector<uint8_t> smallPng(uint8_t grey) {
    return encodePng({{4, 4}, std::vector<uint8_t>(4 * 4 * 4, grey)}, {});
}

/// What the other good files have not: textures on two sets of coordinates, every layer of a material, variants,
/// weights that are animated, instances without a buffer view, lights, cameras, and a joint outside the scene.
inline void addAllThatIsShaded(GltfBuilder& file) {
    using nlohmann::json;
    file.triangle();
    json& primitive = file.primitive();
    json& attributes = primitive["attributes"];
    attributes["NORMAL"] = file.floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3);
    attributes["TANGENT"] = file.floats({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, -1}, "VEC4", 4);
    attributes["TEXCOORD_0"] = file.floats({0, 0, 1, 0, 0, 1}, "VEC2", 2);
    attributes["TEXCOORD_1"] = file.floats({0, 0, 2, 0, 0, 3}, "VEC2", 2);
    attributes["COLOR_0"] = file.floats({1, 1, 1, 1, 0, 0, 0, 1, 0}, "VEC3", 3);
    attributes["JOINTS_0"] = file.accessor(std::vector<uint8_t>(12, 0), "VEC4", 4, 5121);
    attributes["WEIGHTS_0"] = file.floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4", 4);
    primitive["targets"] = {{{"POSITION", file.floats({0, 0, 1, 0, 0, 0, 0, 0, 0}, "VEC3", 3)}},
                            {{"NORMAL", file.floats({0, 1, 0, 0, 0, 0, 0, 0, 0}, "VEC3", 3)}}};
    file.json["meshes"][0]["weights"] = {0.5, 0};
    primitive["material"] = 0;
    primitive["extensions"]["KHR_materials_variants"]["mappings"] = {{{"material", 1}, {"variants", {0}}}};

    const std::vector<uint8_t> light = smallPng(200), dark = smallPng(90);
    file.json["images"] = {{{"bufferView", file.view(light.data(), light.size())}, {"mimeType", "image/png"}},
                           {{"uri", "data:image/png;base64," + base64(dark)}}};
    file.json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}}};
    file.json["textures"] = {{{"source", 0}, {"sampler", 0}}, {{"source", 1}}};
    const json second = {{"index", 1}, {"texCoord", 1}};
    const json moved = {
        {"index", 0},
        {"extensions", {{"KHR_texture_transform", {{"offset", {0.1, 0.2}}, {"rotation", 0.3}, {"scale", {2, 3}}}}}}};
    const json layers = {
        {"KHR_materials_clearcoat",
         {{"clearcoatFactor", 0.5}, {"clearcoatTexture", second}, {"clearcoatNormalTexture", moved}}},
        {"KHR_materials_sheen",
         {{"sheenColorFactor", {0.2, 0.3, 0.4}}, {"sheenRoughnessFactor", 0.4}, {"sheenColorTexture", moved}}},
        {"KHR_materials_anisotropy",
         {{"anisotropyStrength", 0.6}, {"anisotropyRotation", 1}, {"anisotropyTexture", second}}},
        {"KHR_materials_iridescence",
         {{"iridescenceFactor", 0.5}, {"iridescenceIor", 1.4}, {"iridescenceThicknessMaximum", 400}}},
        {"KHR_materials_specular",
         {{"specularFactor", 0.7}, {"specularColorFactor", {1, 0.9, 0.8}}, {"specularTexture", second}}},
        {"KHR_materials_emissive_strength", {{"emissiveStrength", 3}}}};
    const json glass = {{"KHR_materials_transmission", {{"transmissionFactor", 0.9}, {"transmissionTexture", moved}}},
                        {"KHR_materials_volume",
                         {{"thicknessFactor", 1}, {"attenuationDistance", 0.5}, {"attenuationColor", {1, 0.5, 0.2}}}},
                        {"KHR_materials_ior", {{"ior", 1.33}}}};
    file.json["materials"] = {
        {{"pbrMetallicRoughness",
          {{"baseColorTexture", moved}, {"metallicRoughnessTexture", second}, {"roughnessFactor", 0.4}}},
         {"normalTexture", {{"index", 1}, {"texCoord", 1}, {"scale", 0.7}}},
         {"emissiveFactor", {0.1, 0.2, 0.3}},
         {"alphaMode", "MASK"},
         {"alphaCutoff", 0.3},
         {"extensions", layers}},
        {{"doubleSided", true}, {"alphaMode", "BLEND"}, {"extensions", glass}}};

    const int times = file.floats({0, 0.5, 1}, "SCALAR", 1);
    const int weights = file.floats({0, 0, 1, 0.5, 0, 1}, "SCALAR", 1);
    const int scales =
        file.floats({0, 0, 0, 1, 1, 1, 1, 1, 1, 0, 0, 0, 2, 2, 2, 0, 0, 0, -1, 0, 0, 1, 1, 1, 0, 0, 0}, "VEC3", 3);
    file.json["animations"] = {{{"samplers",
                                 {{{"input", times}, {"output", weights}},
                                  {{"input", times}, {"output", scales}, {"interpolation", "CUBICSPLINE"}}}},
                                {"channels",
                                 {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}},
                                  {{"sampler", 0}, {"target", {{"node", 4}, {"path", "weights"}}}},
                                  {{"sampler", 1}, {"target", {{"node", 1}, {"path", "scale"}}}}}}}};
    file.json["accessors"].push_back({{"componentType", 5126}, {"count", 3}, {"type", "VEC3"}});
    const auto unviewed = static_cast<int>(file.json["accessors"].size()) - 1;
    file.json["nodes"] = {
        {{"mesh", 0}, {"skin", 0}, {"translation", {0, 0, -1}}},
        {{"mesh", 0},
         {"scale", {1, 1, 0.5}},
         {"children", {2, 3}},
         {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", unviewed}}}}}}}},
        {{"camera", 0}, {"translation", {0, 0, 3}}},
        {{"rotation", {0, 0.6, 0, 0.8}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}},
        {{"mesh", 0}, {"camera", 0}, {"translation", {0, 0, 1}}}};
    file.json["skins"] = {{{"joints", {4}}}};
    file.json["scenes"] = {{{"nodes", {0, 1}}}};
    file.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}}}}};
    file.json["extensions"] = {
        {"KHR_lights_punctual",
         {{"lights", {{{"type", "spot"}, {"intensity", 5}, {"spot", {{"outerConeAngle", 0.7}}}}}}}},
        {"KHR_materials_variants", {{"variants", {{{"name", "glass"}}}}}}};
}

/// A file as one text, its buffer in it.
inline std::string asText(const GltfBuilder& file) {
    nlohmann::json all = file.json;
    all["buffers"] = {
        {{"byteLength", file.bin.size()}, {"uri", "data:application/octet-stream;base64," + base64(file.bin)}}};
    return all.dump(1);
}

/// A quad and a triangle that wear two materials, one of them with what MTL files can say.
constexpr const char* kObjWithMaterials =
    "mtllib mesh.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\no part\n"
    "usemtl red\nf 1/1/1 2/2/1 3/3/1 4/1/1\nusemtl lamp\nf 1/1 2/2 5/3\n";
constexpr const char* kMaterials =
    "newmtl red\nKd 0.8 0.1 0.1\nKs 0.2 0.2 0.2\nNs 40\nNi 1.4\nd 0.9\nillum 2\nmap_Kd -s 2 3 1 -o 0.1 0.2 0 map.png\n"
    "bump -bm 0.5 map.png\nPr 0.3\nPm 0.5\nPc 0.4\nPcr 0.1\naniso 0.2\nnewmtl lamp\nKd 0 0 0\nKe 4 3 2\nmap_Ke "
    "map.png\nTr 0\n";

/// A cube with tags as control cage, and the scene that subdivides it.
constexpr const char* kCage =
    "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 "
    "1\n"
    "f 1/1 4/4 3/3 2/2\nf 5/1 6/2 7/3 8/4\nf 1/1 2/2 6/3 5/4\nf 2/1 3/2 7/3 6/4\nf 3/1 4/2 8/3 7/4\nf 4/1 1/2 5/3 8/4\n"
    "t crease 2/1/0 0 1 3.5\nt corner 1/1/0 6 2\nt interpolateboundary 1/0/0 1\nt hole 1/0/0 0\n";
constexpr const char* kCageScene =
    R"({"version": 1, "assets": {"cage": {"obj": "cage.obj", "subdivision": "catmull-clark", "rate": 2}},
 "materials": {"red": {}}, "instances": [{"name": "a", "asset": "cage", "material": "red"}],
 "lights": {"lamp": {"rectangle": {}, "translate": [0, 4, 0], "look-at": [0, 0, 0]}}, "cameras": {"main": {}}})";

}  // namespace lumi::test
