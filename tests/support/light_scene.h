#pragma once
#include "math/hash.h"
#include "support/transport_scene.h"
#include "trace/trace_scene.h"

namespace lumi::test {

/// Plain random numbers by counting.
class Numbers {
public:
    explicit Numbers(uint32_t seed) : seed_(seed) {}
    float one() { return unitFloat(hashCombine(seed_, count_++)); }
    Vec2 two() {
        const float a = one();
        return {a, one()};
    }

private:
    uint32_t seed_, count_ = 0;
};

inline void bindTo(TraceScene& scene, std::shared_ptr<const PosedScene> posed) {
    scene.posed = std::move(posed);
    scene.embree.bind(*scene.posed);
    scene.tables = makeSceneTables(*scene.posed, scene.embree);
    scene.lights.build(*scene.posed, scene.tables);
}

/// Emissive triangles of three instances, one mirrored, one shared; a lamp of each kind.
inline TinyScene manyLights() {
    TinyScene tiny;
    Material glow = lambert(0);
    glow.emission = Vec3(2);
    const int material = tiny.addMaterial(glow);
    const auto ball = std::make_shared<const Mesh>(facetedSphere(0.4f, 12));
    tiny.add(ball, material, translation(Vec3(-2, 0, 0)));
    tiny.add(ball, material, translation(Vec3(0, 0, -2)) * scaling(Vec3(-1, 0.5f, 1.5f)));
    glow.clearcoat = 0.9f;
    tiny.add(facetedSphere(0.2f, 6), glow, translation(Vec3(1.2f, -1.2f, 0.8f)));
    Light light;
    light.type = LightType::Rectangle;
    tiny.addLight(light, lookAt(Vec3(2, 0.5f, 0), Vec3(0)));
    light.type = LightType::Sphere;
    light.radius = 0.4f;
    tiny.addLight(light, translation(Vec3(0, 2, 0)));
    light.type = LightType::Disk;
    tiny.addLight(light, lookAt(Vec3(0, 0, 2), Vec3(0)));
    light.type = LightType::Point;
    tiny.addLight(light, translation(Vec3(0.3f, -0.5f, 0.2f)));
    tiny.scene.environment.constant = Vec3(0.2f);
    return tiny;
}

}  // namespace lumi::test
