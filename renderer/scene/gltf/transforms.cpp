#include "scene/gltf/transforms.h"

#include <cmath>
#include <optional>

namespace lumi::gltf {
namespace {

/// The transform whose matrix is `m`, if there is one up to rounding.
std::optional<Transform> decompose(const Mat4& m) {
    Transform t;
    t.translation = Vec3(m[3]);
    t.scale = {glm::length(Vec3(m[0])), glm::length(Vec3(m[1])), glm::length(Vec3(m[2]))};
    if (!(minComponent(t.scale) > 0)) return std::nullopt;
    if (isMirroring(m)) t.scale.x = -t.scale.x;
    const Mat3 rotation(Vec3(m[0]) / t.scale.x, Vec3(m[1]) / t.scale.y, Vec3(m[2]) / t.scale.z);
    t.rotation = glm::normalize(glm::quat_cast(rotation));
    const Mat4 again = t.matrix();
    const float tolerance = 2e-6f * maxComponent(glm::abs(t.scale));
    for (int column = 0; column < 3; ++column)
        if (maxComponent(glm::abs(Vec3(again[column]) - Vec3(m[column]))) > tolerance) return std::nullopt;
    return t;
}

std::vector<float> finiteNumbers(const Document& document, const std::vector<double>& values, const std::string& path) {
    std::vector<float> numbers(values.begin(), values.end());
    for (const float number : numbers)
        if (!std::isfinite(number)) document.fail(path, "a value is not finite");
    return numbers;
}

}  // namespace

bool isFiniteMatrix(const Mat4& m) {
    for (int column = 0; column < 4; ++column)
        if (!isFinite(Vec3(m[column])) || !std::isfinite(m[column].w)) return false;
    return true;
}

Quat unitRotation(const Vec4& xyzw) {
    const float length = glm::length(xyzw);
    if (!(length > 0) || !std::isfinite(length)) return Quat(1, 0, 0, 0);
    return Quat(xyzw.w / length, xyzw.x / length, xyzw.y / length, xyzw.z / length);
}

void readTransform(const Document& document, const tinygltf::Node& source, const std::string& path, Node& node) {
    if (!source.matrix.empty()) {
        const std::vector<float> m = finiteNumbers(document, source.matrix, path + "/matrix");
        for (size_t i = 0; i < 16; ++i) node.matrix[static_cast<int>(i / 4)][static_cast<int>(i % 4)] = m[i];
        for (int column = 0; column < 4; ++column) node.matrix[column].w = column == 3 ? 1.0f : 0.0f;
        if (const auto transform = decompose(node.matrix)) node.local = *transform;
        else node.hasMatrix = true;
        return;
    }
    if (!source.translation.empty()) {
        const std::vector<float> t = finiteNumbers(document, source.translation, path + "/translation");
        node.local.translation = {t[0], t[1], t[2]};
    }
    if (!source.rotation.empty()) {
        const std::vector<float> r = finiteNumbers(document, source.rotation, path + "/rotation");
        node.local.rotation = unitRotation({r[0], r[1], r[2], r[3]});
    }
    if (!source.scale.empty()) {
        const std::vector<float> s = finiteNumbers(document, source.scale, path + "/scale");
        node.local.scale = {s[0], s[1], s[2]};
    }
}

}  // namespace lumi::gltf
