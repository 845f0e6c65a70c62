#pragma once
#include <cmath>
#include <memory>
#include <vector>

#include "math/statistics.h"
#include "scene/light_body.h"
#include "scene/posed_scene.h"
#include "scene/procedural/primitives.h"
#include "trace/tracer.h"

namespace lumi::test {

/// A pure Lambertian of the given reflectance: no layer above it.
inline Material lambert(const Vec3& reflectance) {
    Material m;
    m.baseColor = reflectance;
    m.specular = 0;
    m.roughness = 1;
    return m;
}
inline Material lambert(float reflectance) { return lambert(Vec3(reflectance)); }

inline Material metal(float reflectance, float roughness) {
    Material m;
    m.baseColor = Vec3(reflectance);
    m.metallic = 1;
    m.roughness = roughness;
    return m;
}

/// One rectangle of `size` around the origin in the xz plane, facing +Y.
inline Mesh floorMesh(float size = 20) { return rectangleMesh(size, size, Facing::Y); }

inline Material glass(float roughness) {
    Material m;
    m.transmission = 1;
    m.thickness = 1;
    m.roughness = roughness;
    m.ior = 1.5f;
    return m;
}

/// A sphere without smooth normals, so that its geometry is all there is.
inline Mesh facetedSphere(float radius, int segments = 32) {
    Mesh mesh = sphereMesh(radius, segments, segments / 2);
    mesh.normals.clear();
    return mesh;
}

inline Mat4 translation(const Vec3& t) {
    Mat4 m(1);
    m[3] = Vec4(t, 1);
    return m;
}
inline Mat4 scaling(const Vec3& s) {
    Mat4 m(1);
    m[0].x = s.x, m[1].y = s.y, m[2].z = s.z;
    return m;
}

/// Builds scenes in memory, a thing at a time.
class TinyScene {
public:
    TinyScene() { scene.cameras.push_back({}); }

    int addMaterial(const Material& material) {
        scene.materials.push_back(material);
        return static_cast<int>(scene.materials.size()) - 1;
    }
    int addNode(const Mat4& worldFromObject) {
        Node node;
        node.hasMatrix = true;
        node.matrix = worldFromObject;
        scene.nodes.push_back(node);
        return static_cast<int>(scene.nodes.size()) - 1;
    }
    /// Returns the instance's index.
    int add(std::shared_ptr<const Mesh> mesh, int material, const Mat4& worldFromObject = Mat4(1)) {
        Instance instance;
        instance.mesh = std::move(mesh);
        instance.material = material;
        instance.node = addNode(worldFromObject);
        scene.instances.push_back(instance);
        return static_cast<int>(scene.instances.size()) - 1;
    }
    int add(Mesh mesh, const Material& material, const Mat4& worldFromObject = Mat4(1)) {
        return add(std::make_shared<const Mesh>(std::move(mesh)), addMaterial(material), worldFromObject);
    }
    void addLight(Light light, const Mat4& worldFromLight) {
        light.node = addNode(worldFromLight);
        scene.lights.push_back(light);
    }

    std::shared_ptr<const PosedScene> pose(ShutterTimes times = {}) {
        if (scene.materials.empty()) addMaterial(Material());
        addLightBodies(scene);
        return poseScene(std::make_shared<const Scene>(scene), times);
    }

    Scene scene;
};

inline Camera lookFrom(const Vec3& eye, const Vec3& target, float fovYDeg = 45) {
    Camera camera;
    camera.eye = eye, camera.target = target, camera.fovYDeg = fovYDeg;
    camera.focus = glm::length(target - eye);
    return camera;
}

/// Settings for statistics: independent numbers, no roulette.
inline PathSettings plainPaths(int maxDepth, DirectStrategy strategy = DirectStrategy::Mis) {
    PathSettings path;
    path.maxDepth = maxDepth;
    path.maxDiffuseDepth = path.maxSpecularDepth = 64;
    path.strategy = strategy;
    path.roulette = false;
    path.sampler = SamplerKind::Independent;
    return path;
}

inline FrameSampling frameOf(const Camera& camera, Extent2 extent, int spp, const PathSettings& path,
                             const SignalSet& wanted, uint32_t seed = 0) {
    FrameSampling sampling;
    sampling.extent = extent;
    sampling.camera = sampling.previousCamera = poseCamera(camera, extent);
    sampling.samplesPerPixel = spp;
    sampling.seed = seed;
    sampling.path = path;
    sampling.wanted = wanted;
    return sampling;
}

struct Estimate {
    double mean = 0, standardError = 0;
    /// Distance to a value in standard errors; rounding counts as 1e-5 of the value.
    double z(double truth) const { return std::abs(mean - truth) / (standardError + 1e-5 * std::abs(truth) + 1e-12); }
};

/// Mean over `count` independent paths of the green radiance along one ray.
inline Estimate radianceAlong(Tracer& tracer, const Vec3& origin, const Vec3& direction, int count,
                              const PathSettings& path, uint32_t seed = 1, bool fromCamera = false) {
    std::vector<PathStart> starts(static_cast<size_t>(count));
    for (size_t i = 0; i < starts.size(); ++i) {
        starts[i].ray.origin = origin;
        starts[i].ray.direction = glm::normalize(direction);
        starts[i].ray.fromCamera = fromCamera;
        starts[i].cone.spread = fromCamera ? 1e-3f : 0.0f;
        starts[i].key = {7, 11, static_cast<uint32_t>(i)};
        starts[i].slot = static_cast<uint32_t>(i);
    }
    std::vector<Vec3> radiance(starts.size());
    tracer.tracePaths(starts, path, seed, radiance, {});
    RunningMoments moments;
    for (const Vec3& r : radiance) moments.add(r.y);
    return {moments.mean(), std::sqrt(moments.meanVariance())};
}

}  // namespace lumi::test
