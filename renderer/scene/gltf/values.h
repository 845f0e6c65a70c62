#pragma once
#include <tiny_gltf.h>

#include <cmath>
#include <string>
#include <vector>

#include "math/vector.h"
#include "scene/gltf/json_guard.h"

namespace lumi::gltf {

/// Reads of extension objects (tinygltf::Value); what is missing, of another type, or not finite gives `otherwise`.
inline float numberOf(const tinygltf::Value& object, const std::string& key, float otherwise) {
    if (!object.IsObject() || !object.Has(key) || !object.Get(key).IsNumber()) return otherwise;
    const float value = static_cast<float>(object.Get(key).GetNumberAsDouble());
    return std::isfinite(value) ? value : otherwise;
}
inline int integerOf(const tinygltf::Value& object, const std::string& key, int otherwise) {
    if (!object.IsObject() || !object.Has(key) || !object.Get(key).IsInt()) return otherwise;
    return object.Get(key).GetNumberAsInt();
}
inline std::string textOf(const tinygltf::Value& object, const std::string& key) {
    if (!object.IsObject() || !object.Has(key) || !object.Get(key).IsString()) return {};
    return object.Get(key).Get<std::string>();
}
template <class Vector>
Vector vectorOf(const tinygltf::Value& object, const std::string& key, Vector otherwise) {
    if (!object.IsObject() || !object.Has(key)) return otherwise;
    const tinygltf::Value& array = object.Get(key);
    if (!array.IsArray() || array.ArrayLen() != static_cast<size_t>(Vector::length())) return otherwise;
    Vector result = otherwise;
    for (int i = 0; i < Vector::length(); ++i) {
        const tinygltf::Value& entry = array.Get(i);
        if (!entry.IsNumber() || !std::isfinite(static_cast<float>(entry.GetNumberAsDouble()))) return otherwise;
        result[i] = static_cast<float>(entry.GetNumberAsDouble());
    }
    return result;
}
inline Vec2 vec2Of(const tinygltf::Value& object, const std::string& key, Vec2 otherwise) {
    return vectorOf(object, key, otherwise);
}
inline Vec3 vec3Of(const tinygltf::Value& object, const std::string& key, Vec3 otherwise) {
    return vectorOf(object, key, otherwise);
}
inline Vec4 vec4Of(const tinygltf::Value& object, const std::string& key, Vec4 otherwise) {
    return vectorOf(object, key, otherwise);
}

/// A colour or vector of plain properties; another length or a value that is not finite gives `otherwise`.
inline Vec3 vec3From(const std::vector<double>& values, Vec3 otherwise) {
    if (values.size() != 3) return otherwise;
    const Vec3 v(static_cast<float>(values[0]), static_cast<float>(values[1]), static_cast<float>(values[2]));
    return isFinite(v) ? v : otherwise;
}

/// The extension of that name, or null.
inline const tinygltf::Value* extensionOf(const tinygltf::ExtensionMap& extensions, const std::string& name) {
    const auto found = extensions.find(name);
    return found != extensions.end() && found->second.IsObject() ? &found->second : nullptr;
}

/// The accessor of the primitive's indices, or -1; see kIndicesAlone.
inline int indicesOf(const tinygltf::Primitive& primitive) {
    const tinygltf::Value* alone = extensionOf(primitive.extensions, kIndicesAlone);
    return alone && primitive.indices < 0 ? integerOf(*alone, "indices", -1) : primitive.indices;
}

}  // namespace lumi::gltf
