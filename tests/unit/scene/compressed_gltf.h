#pragma once
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <meshoptimizer.h>

#include <array>
#include <cmath>
#include <memory>

#include "unit/scene/gltf_support.h"

namespace lumi::test {

/// A wavy sheet of n x n squares with normals and texture coordinates.
struct Sheet {
    std::vector<Vec3> positions, normals;
    std::vector<Vec2> uvs;
    std::vector<uint32_t> indices;

    explicit Sheet(uint32_t n) {
        for (uint32_t y = 0; y <= n; ++y)
            for (uint32_t x = 0; x <= n; ++x) {
                const float u = float(x) / float(n), v = float(y) / float(n), h = 0.3f * std::sin(5 * u);
                positions.emplace_back(u, h, v);
                normals.push_back(glm::normalize(Vec3(-1.5f * std::cos(5 * u), 1, 0)));
                uvs.emplace_back(u, v);
            }
        for (uint32_t y = 0; y < n; ++y)
            for (uint32_t x = 0; x < n; ++x) {
                const uint32_t a = y * (n + 1) + x, b = a + 1, c = a + n + 1, d = c + 1;
                indices.insert(indices.end(), {a, c, b, b, c, d});
            }
    }
};

struct DracoFile {
    std::vector<char> bytes;
    int points = 0, position = -1, normal = -1, uv = -1;
};

inline DracoFile encodeDraco(const Sheet& sheet, int method) {
    const auto faces = static_cast<int>(sheet.indices.size() / 3);
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(faces);
    const int position = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    const int normal = builder.AddAttribute(draco::GeometryAttribute::NORMAL, 3, draco::DT_FLOAT32);
    const int uv = builder.AddAttribute(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32);
    for (int f = 0; f < faces; ++f) {
        const uint32_t* i = &sheet.indices[3 * static_cast<size_t>(f)];
        const draco::FaceIndex face(static_cast<uint32_t>(f));
        builder.SetAttributeValuesForFace(position, face, &sheet.positions[i[0]], &sheet.positions[i[1]],
                                          &sheet.positions[i[2]]);
        builder.SetAttributeValuesForFace(normal, face, &sheet.normals[i[0]], &sheet.normals[i[1]],
                                          &sheet.normals[i[2]]);
        builder.SetAttributeValuesForFace(uv, face, &sheet.uvs[i[0]], &sheet.uvs[i[1]], &sheet.uvs[i[2]]);
    }
    const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
    draco::Encoder encoder;
    encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 14);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::TEX_COORD, 12);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::NORMAL, 10);
    encoder.SetEncodingMethod(method);
    draco::EncoderBuffer buffer;
    if (!encoder.EncodeMeshToBuffer(*mesh, &buffer).ok()) return {};
    const auto id = [&](int attribute) { return static_cast<int>(mesh->attribute(attribute)->unique_id()); };
    return {*buffer.buffer(), static_cast<int>(mesh->num_points()), id(position), id(normal), id(uv)};
}

inline void addDraco(GltfBuilder& file, const DracoFile& draco, size_t indices) {
    const int view = file.view(draco.bytes.data(), draco.bytes.size());
    for (const char* type : {"VEC3", "VEC3", "VEC2"})
        file.json["accessors"].push_back({{"componentType", 5126}, {"count", draco.points}, {"type", type}});
    file.json["accessors"].push_back({{"componentType", 5123}, {"count", indices}, {"type", "SCALAR"}});
    nlohmann::json primitive = {{"attributes", {{"POSITION", 0}, {"NORMAL", 1}, {"TEXCOORD_0", 2}}}, {"indices", 3}};
    primitive["extensions"]["KHR_draco_mesh_compression"] = {
        {"bufferView", view},
        {"attributes", {{"POSITION", draco.position}, {"NORMAL", draco.normal}, {"TEXCOORD_0", draco.uv}}}};
    file.json["meshes"].push_back({{"primitives", {primitive}}});
    file.json["extensionsUsed"] = file.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
}

/// Appends compressed bytes to the file's buffer, and a view into a fallback buffer that does not exist.
inline int meshoptView(GltfBuilder& file, const std::vector<unsigned char>& bytes, size_t count, size_t stride,
                       const char* mode, const char* filter = nullptr) {
    const int view = file.view(bytes.data(), bytes.size());
    nlohmann::json& v = file.json["bufferViews"][static_cast<size_t>(view)];
    nlohmann::json extension = {{"buffer", 0},
                                {"byteOffset", v["byteOffset"]},
                                {"byteLength", bytes.size()},
                                {"byteStride", stride},
                                {"count", count},
                                {"mode", mode}};
    if (filter) extension["filter"] = filter;
    v = {{"buffer", 1},
         {"byteOffset", 0},
         {"byteLength", count * stride},
         {"extensions", {{"EXT_meshopt_compression", extension}}}};
    if (std::string(mode) == "ATTRIBUTES") v["byteStride"] = stride;
    return view;
}

template <class T>
std::vector<unsigned char> encodeVertices(const std::vector<T>& values) {
    std::vector<unsigned char> bytes(meshopt_encodeVertexBufferBound(values.size(), sizeof(T)));
    bytes.resize(meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), values.data(), values.size(), sizeof(T)));
    return bytes;
}

/// The sheet with quantised positions, octahedral normals and exponential texture coordinates. The fallback buffer has
/// no bytes anywhere.
inline void addMeshopt(GltfBuilder& file, const Sheet& sheet, bool sequence) {
    const size_t n = sheet.positions.size();
    std::vector<std::array<uint16_t, 4>> positions(n);
    for (size_t i = 0; i < n; ++i)
        for (int c = 0; c < 3; ++c)
            positions[i][static_cast<size_t>(c)] =
                static_cast<uint16_t>(std::lround((sheet.positions[i][c] + 1) * 30000));
    std::vector<Vec4> padded(n, Vec4(0));
    for (size_t i = 0; i < n; ++i) padded[i] = Vec4(sheet.normals[i], 0);
    std::vector<std::array<int8_t, 4>> normals(n);
    meshopt_encodeFilterOct(normals.data(), n, 4, 8, &padded[0].x);
    std::vector<std::array<uint32_t, 2>> uvs(n);
    meshopt_encodeFilterExp(uvs.data(), n, 8, 15, &sheet.uvs[0].x);

    std::vector<unsigned char> indices(meshopt_encodeIndexBufferBound(sheet.indices.size(), n));
    if (sequence) {
        indices.resize(meshopt_encodeIndexSequenceBound(sheet.indices.size(), n));
        indices.resize(
            meshopt_encodeIndexSequence(indices.data(), indices.size(), sheet.indices.data(), sheet.indices.size()));
    } else {
        indices.resize(
            meshopt_encodeIndexBuffer(indices.data(), indices.size(), sheet.indices.data(), sheet.indices.size()));
    }
    meshoptView(file, encodeVertices(positions), n, 8, "ATTRIBUTES");
    meshoptView(file, encodeVertices(normals), n, 4, "ATTRIBUTES", "OCTAHEDRAL");
    meshoptView(file, encodeVertices(uvs), n, 8, "ATTRIBUTES", "EXPONENTIAL");
    meshoptView(file, indices, sheet.indices.size(), 4, sequence ? "INDICES" : "TRIANGLES");
    file.json["accessors"] = {
        {{"bufferView", 0}, {"componentType", 5123}, {"count", n}, {"type", "VEC3"}},
        {{"bufferView", 1}, {"componentType", 5120}, {"normalized", true}, {"count", n}, {"type", "VEC3"}},
        {{"bufferView", 2}, {"componentType", 5126}, {"count", n}, {"type", "VEC2"}},
        {{"bufferView", 3}, {"componentType", 5125}, {"count", sheet.indices.size()}, {"type", "SCALAR"}}};
    file.json["meshes"].push_back(
        {{"primitives", {{{"attributes", {{"POSITION", 0}, {"NORMAL", 1}, {"TEXCOORD_0", 2}}}, {"indices", 3}}}}});
    file.json["extensionsUsed"] =
        file.json["extensionsRequired"] = {"EXT_meshopt_compression", "KHR_mesh_quantization"};
    file.extraBuffers = {
        {{"byteLength", 1 << 20}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
}

/// A triangle whose textures are in formats that the loader does not read: two in KTX2, one in WebP.
inline void addForeignTextures(GltfBuilder& file) {
    file.triangle();
    file.primitive()["attributes"]["TEXCOORD_0"] = file.floats({0, 0, 1, 0, 0, 1}, "VEC2", 2);
    file.primitive()["material"] = 0;
    const std::string ktx = std::string("\xABKTX 20\xBB\r\n\x1A\n", 12) + std::string(64, '\0');
    const std::string webp = "RIFF" + std::string("\x20\0\0\0", 4) + "WEBPVP8 " + std::string(32, '\0');
    file.json["images"] = {{{"bufferView", file.view(ktx.data(), ktx.size())}, {"mimeType", "image/ktx2"}},
                           {{"bufferView", file.view(webp.data(), webp.size())}, {"mimeType", "image/webp"}}};
    file.json["textures"] = {{{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}},
                             {{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}},
                             {{"source", 1}}};
    file.json["materials"] = {
        {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}, {"metallicRoughnessTexture", {{"index", 1}}}}},
         {"emissiveTexture", {{"index", 2}}}}};
    file.json["extensionsUsed"] = file.json["extensionsRequired"] = {"KHR_texture_basisu", "EXT_texture_webp"};
}

}  // namespace lumi::test
