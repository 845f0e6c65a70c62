#include "scene/light_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <tuple>

#include "scene/file_warnings.h"
#include "scene/procedural/primitives.h"

namespace lumi {
namespace {

constexpr const char* kBodyMaterial = "light body";

double areaOf(const Mesh& mesh) {
    double area = 0;
    for (const UVec3& t : mesh.triangles)
        area += 0.5 * glm::length(glm::cross(mesh.positions[t.y] - mesh.positions[t.x],
                                             mesh.positions[t.z] - mesh.positions[t.x]));
    return area;
}

Mesh sphereBody(float radius) {
    // Facets lie inside the sphere. The mean solid angle of a convex body goes with its area, so that is made exact.
    Mesh mesh = sphereMesh(radius, 96, 48);
    const double wanted = 4 * 3.14159265358979323846 * double(radius) * radius;
    const auto growth = static_cast<float>(std::sqrt(wanted / areaOf(mesh)));
    for (Vec3& p : mesh.positions) p *= growth;
    return mesh;
}

/// Material that bodies wear: black, since what they emit is the light's.
int bodyMaterial(Scene& scene) {
    for (size_t i = 0; i < scene.materials.size(); ++i)
        if (scene.materials[i].name == kBodyMaterial) return static_cast<int>(i);
    Material black;
    black.name = kBodyMaterial;
    black.baseColor = Vec3(0);
    black.specular = 0;
    black.roughness = 1;
    scene.materials.push_back(black);
    return static_cast<int>(scene.materials.size()) - 1;
}

bool wornOtherwise(const Scene& scene, uint32_t material) {
    for (const Instance& instance : scene.instances) {
        if (instance.light >= 0) continue;
        if (instance.material >= 0 ? instance.material == static_cast<int>(material)
                                   : instance.mesh->material == material)
            return true;
        const std::vector<uint32_t>& ofTriangles = instance.mesh->triangleMaterial;
        if (instance.material < 0 && std::find(ofTriangles.begin(), ofTriangles.end(), material) != ofTriangles.end())
            return true;
    }
    return false;
}

/// Lights for which this is equal have the same body.
using Size = std::tuple<LightType, float, float, float>;
Size sizeOf(const Light& light) { return {light.type, light.radius, light.size.x, light.size.y}; }

Vec3 lengthsOfAxes(const Mat4& m) {
    return {glm::length(Vec3(m[0])), glm::length(Vec3(m[1])), glm::length(Vec3(m[2]))};
}

bool sameShape(const Mesh& a, const Mesh& b) { return a.positions == b.positions; }

}  // namespace

std::shared_ptr<const Mesh> lightBody(const Light& light) {
    Mesh mesh;
    switch (light.type) {
        case LightType::Rectangle: mesh = rectangleMesh(light.size.x, light.size.y, Facing::MinusZ); break;
        case LightType::Disk: mesh = diskMesh(light.radius, 0, Facing::MinusZ, 128); break;
        case LightType::Sphere: mesh = sphereBody(light.radius); break;
        default: return nullptr;
    }
    mesh.name = light.name;
    return std::make_shared<const Mesh>(std::move(mesh));
}

void addLightBodies(Scene& scene) {
    std::vector<int> shownBy(scene.lights.size(), -1);
    for (size_t k = 0; k < scene.instances.size(); ++k)
        if (const int light = scene.instances[k].light; light >= 0)
            shownBy[static_cast<size_t>(light)] = static_cast<int>(k);
    std::map<Size, std::shared_ptr<const Mesh>> bodies;
    int material = -1;
    for (size_t i = 0; i < scene.lights.size(); ++i) {
        const Light& light = scene.lights[i];
        const auto [place, isNew] = bodies.try_emplace(sizeOf(light));
        std::shared_ptr<const Mesh>& body = place->second;
        if (isNew) body = lightBody(light);
        if (!body) continue;
        if (shownBy[i] >= 0) {
            std::shared_ptr<const Mesh>& shown = scene.instances[static_cast<size_t>(shownBy[i])].mesh;
            if (sameShape(*shown, *body)) body = shown;
            else shown = body;
            continue;
        }
        if (material < 0) material = bodyMaterial(scene);
        scene.instances.push_back({light.name, body, light.node, -1, material, static_cast<int>(i)});
    }
}

float sphereScale(const Mat4& worldFromLight) {
    const Vec3 axes = lengthsOfAxes(worldFromLight);
    const float longest = maxComponent(axes);
    if (minComponent(axes) >= (1 - 1e-5f) * longest) return (axes.x + axes.y + axes.z) * (1.0f / 3.0f);
    constexpr float kPower = 1.6075f;
    const Vec3 powers = glm::pow(axes / longest, Vec3(kPower));
    const float sum = powers.x * powers.y + powers.y * powers.z + powers.z * powers.x;
    return longest * std::pow(sum * (1.0f / 3.0f), 0.5f / kPower);
}

void warnOfStretchedLights(const PosedScene& posed, MessageLog& log) {
    FileWarnings warnings(std::filesystem::path(posed.scene->path).filename().string(), log);
    for (size_t i = 0; i < posed.lights.size(); ++i) {
        const Light& light = posed.scene->lights[i];
        const Mat4& frame = posed.lights[i].worldFromLight;
        const Vec3 axes = lengthsOfAxes(frame);
        if (light.type != LightType::Sphere || minComponent(axes) >= 0.99f * maxComponent(axes)) continue;
        warnings.warn(fmt::format(
            "the sphere light \"{}\" is scaled by {:.4g} x {:.4g} x {:.4g}: shown is a sphere of the same area, "
            "radius {:.4g} m",
            light.name, axes.x, axes.y, axes.z, light.radius * sphereScale(frame)));
    }
    warnings.tellOfMore();
}

std::vector<bool> bodyMaterials(const Scene& scene) {
    std::vector<bool> bodies(scene.materials.size(), false);
    for (const Instance& instance : scene.instances)
        if (instance.light >= 0 && instance.material >= 0) bodies[static_cast<size_t>(instance.material)] = true;
    for (size_t i = 0; i < bodies.size(); ++i)
        if (bodies[i])
            bodies[i] = scene.materials[i].name == kBodyMaterial && !wornOtherwise(scene, static_cast<uint32_t>(i));
    return bodies;
}

}  // namespace lumi
