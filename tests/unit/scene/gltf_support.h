#pragma once
#include <cstring>
#include <filesystem>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/files.h"
#include "scene/gltf/load_gltf.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace lumi::test {

/// Builds small glTF files, good ones and broken ones: fill `json`, add accessors, write, load.
class GltfBuilder {
public:
    nlohmann::json json = {{"asset", {{"version", "2.0"}}},
                           {"scene", 0},
                           {"scenes", {{{"nodes", {0}}}}},
                           {"nodes", {{{"mesh", 0}}}},
                           {"meshes", nlohmann::json::array()}};
    std::vector<uint8_t> bin;
    nlohmann::json extraBuffers = nlohmann::json::array();  ///< after the GLB's own

    /// Appends bytes as a buffer view and returns its index.
    int view(const void* data, size_t bytes, int stride = 0) {
        while (bin.size() % 4 != 0) bin.push_back(0);
        nlohmann::json v = {{"buffer", 0}, {"byteOffset", bin.size()}, {"byteLength", bytes}};
        if (stride > 0) v["byteStride"] = stride;
        json["bufferViews"].push_back(v);
        const auto* p = static_cast<const uint8_t*>(data);
        bin.insert(bin.end(), p, p + bytes);
        return static_cast<int>(json["bufferViews"].size()) - 1;
    }
    template <class T>
    int accessor(const std::vector<T>& values, const char* type, int components, int componentType) {
        const int v = view(values.data(), values.size() * sizeof(T));
        json["accessors"].push_back({{"bufferView", v},
                                     {"componentType", componentType},
                                     {"count", values.size() / static_cast<size_t>(components)},
                                     {"type", type}});
        return static_cast<int>(json["accessors"].size()) - 1;
    }
    int floats(const std::vector<float>& values, const char* type, int components) {
        return accessor(values, type, components, 5126);
    }
    int indices(const std::vector<uint16_t>& values) { return accessor(values, "SCALAR", 1, 5123); }

    /// A mesh of one triangle with corners (0,0,0), (1,0,0), (0,1,0).
    GltfBuilder& triangle() {
        const int p = floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3);
        const int i = indices({0, 1, 2});
        json["meshes"].push_back({{"primitives", {{{"attributes", {{"POSITION", p}}}, {"indices", i}}}}});
        return *this;
    }
    nlohmann::json& primitive() { return json["meshes"][0]["primitives"][0]; }

    std::vector<uint8_t> glb() const {
        nlohmann::json all = json;
        if (!bin.empty()) all["buffers"] = {{{"byteLength", bin.size()}}};
        for (const nlohmann::json& buffer : extraBuffers) all["buffers"].push_back(buffer);
        std::string text = all.dump();
        while (text.size() % 4 != 0) text += ' ';
        std::vector<uint8_t> padded = bin, out;
        while (padded.size() % 4 != 0) padded.push_back(0);
        const auto word = [&](size_t value) {
            for (int i = 0; i < 4; ++i) out.push_back(static_cast<uint8_t>(value >> (8 * i)));
        };
        word(0x46546C67), word(2), word(20 + text.size() + (padded.empty() ? 0 : 8 + padded.size()));
        word(text.size()), word(0x4E4F534A);
        out.insert(out.end(), text.begin(), text.end());
        if (!padded.empty()) {
            word(padded.size()), word(0x004E4942);
            out.insert(out.end(), padded.begin(), padded.end());
        }
        return out;
    }
    Scene load(MessageLog& log, const LoadOptions& options = {}) const {
        writeFileAtomically(folder_ / "test.glb", glb());
        return loadGltf(folder_ / "test.glb", log, options);
    }
    Scene load() const {
        MessageLog log;
        return load(log);
    }
    void expectRefused(const std::initializer_list<std::string>& parts, ErrorKind kind = ErrorKind::BadInput) const {
        expectError(
            kind, [&] { load(); }, parts);
    }
    const TemporaryFolder& folder() const { return folder_; }

private:
    TemporaryFolder folder_;
};

}  // namespace lumi::test
