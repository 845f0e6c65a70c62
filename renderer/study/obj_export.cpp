#include "study/obj_export.h"

#include <fmt/format.h>

#include <iterator>

#include "base/files.h"
#include "scene/posed_scene.h"

namespace lumi {
namespace {

std::string materialText(const Scene& scene) {
    std::string text;
    for (size_t i = 0; i < scene.materials.size(); ++i) {
        const Vec3 colour = scene.materials[i].baseColor;
        fmt::format_to(std::back_inserter(text), "newmtl m{}\nKd {} {} {}\nKs 0 0 0\nillum 1\n", i, colour.x, colour.y,
                       colour.z);
    }
    return text;
}

/// Numbers that the next instance's first vertex and normal have.
struct NextNumbers {
    size_t position = 1, normal = 1;
};

void addInstance(const PosedScene& posed, uint32_t index, NextNumbers& next, std::string& text) {
    const Mesh& mesh = posed.mesh(index);
    const PosedInstance& pose = posed.instances[index];
    const auto out = std::back_inserter(text);
    fmt::format_to(out, "g i{}\n", index);
    for (const Vec3& position : mesh.positions) {
        const Vec3 p = transformPoint(pose.worldFromObject, position);
        fmt::format_to(out, "v {} {} {}\n", p.x, p.y, p.z);
    }
    const Mat3 normalFromObject = pose.normalFromObject();
    for (const Vec3& normal : mesh.normals) {
        const Vec3 n = normalFromObject * normal;
        const float length = glm::length(n);
        const Vec3 unit = length > 0 ? n / length : Vec3(0, 1, 0);
        fmt::format_to(out, "vn {} {} {}\n", unit.x, unit.y, unit.z);
    }
    uint32_t material = ~0u;
    for (uint32_t k = 0; k < mesh.triangles.size(); ++k) {
        if (posed.materialIndex(index, k) != material) {
            material = posed.materialIndex(index, k);
            fmt::format_to(out, "usemtl m{}\n", material);
        }
        const UVec3 t = mesh.triangles[k];
        text += 'f';
        for (int corner = 0; corner < 3; ++corner) {
            fmt::format_to(out, " {}", next.position + t[corner]);
            if (!mesh.normals.empty()) fmt::format_to(out, "//{}", next.normal + t[corner]);
        }
        text += '\n';
    }
    next.position += mesh.positions.size();
    next.normal += mesh.normals.size();
}

}  // namespace

void exportObj(const Scene& scene, const std::filesystem::path& path) {
    const auto posed = poseScene(std::make_shared<const Scene>(scene), {});
    const std::filesystem::path materials = std::filesystem::path(path).replace_extension(".mtl");
    std::string text = "mtllib " + materials.filename().string() + "\n";
    NextNumbers next;
    for (uint32_t i = 0; i < scene.instances.size(); ++i)
        if (const Mesh* mesh = scene.instances[i].mesh.get(); mesh && !mesh->triangles.empty())
            addInstance(*posed, i, next, text);
    writeFileAtomically(materials, materialText(scene));
    writeFileAtomically(path, text);
}

}  // namespace lumi
