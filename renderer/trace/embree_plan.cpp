// How each instance of a posed scene is attached to Embree.
#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "scene/reach.h"
#include "trace/embree_parts.h"

namespace lumi {
namespace {

/// For each node: does an animation move it or one of its parents?
std::vector<bool> animatedNodes(const Scene& scene) {
    std::vector<bool> animated(scene.nodes.size(), false);
    for (const Animation& animation : scene.animations)
        for (const AnimationChannel& channel : animation.channels)
            if (channel.property != AnimatedProperty::MorphWeights && channel.node >= 0)
                animated[static_cast<size_t>(channel.node)] = true;
    for (size_t i = 0; i < scene.nodes.size(); ++i)
        if (scene.nodes[i].parent >= 0 && animated[static_cast<size_t>(scene.nodes[i].parent)]) animated[i] = true;
    return animated;
}

bool hasAlpha(const Scene& scene, uint32_t material) {
    return material < scene.materials.size() && scene.materials[material].hasAlpha();
}

/// Has any of the mesh's own materials alpha?
bool hasAlpha(const Scene& scene, const Mesh& mesh) {
    const auto masked = [&](uint32_t material) { return hasAlpha(scene, material); };
    if (mesh.triangleMaterial.empty()) return masked(mesh.material);
    return std::any_of(mesh.triangleMaterial.begin(), mesh.triangleMaterial.end(), masked);
}

/// Does `m` leave nothing to be seen of meshes in reach, a line or a point?
bool isSpeck(const Mat4& m) {
    const glm::dmat3 d{glm::dmat4(m)};
    const glm::dvec3 cofactors[] = {glm::cross(d[0], d[1]), glm::cross(d[1], d[2]), glm::cross(d[2], d[0])};
    return std::all_of(std::begin(cofactors), std::end(cofactors),
                       [](const glm::dvec3& c) { return glm::length(c) < 1e-38; });
}

bool isAlwaysSpeck(const PosedInstance& pose) {
    const auto isAt = [](const Mat4& m) { return isSpeck(m); };
    return isSpeck(pose.worldFromObject) && (!pose.track() || std::ranges::all_of(pose.track()->worldFromObject, isAt));
}

/// carriesRays() at all moments of the open shutter: between two of them a mirroring flattens too.
bool alwaysCarriesRays(const PosedInstance& pose) {
    if (!carriesRays(pose.worldFromObject)) return false;
    if (!pose.track()) return true;
    const bool mirroring = isMirroring(pose.worldFromObject);
    return std::all_of(pose.track()->worldFromObject.begin(), pose.track()->worldFromObject.end(),
                       [&](const Mat4& m) { return carriesRays(m) && isMirroring(m) == mirroring; });
}

const Mesh* meshOf(const PosedScene& posed, size_t instance) { return posed.scene->instances[instance].mesh.get(); }

}  // namespace

EmbreeScene::Body::Body(const PosedScene& posed, uint32_t instance) {
    const auto light = static_cast<size_t>(posed.scene->instances[instance].light);
    shape = lightShape(posed.scene->lights[light], posed.lights[light].worldFromLight);
    shutterShapes = lightShapes(posed.scene->lights[light], posed.lights[light].track);
    const auto forgetEmission = [](LightShape& s) { s.radiance = Vec3(0), s.texture = nullptr; };
    forgetEmission(shape);
    for (LightShape& later : shutterShapes) forgetEmission(later);
}

std::vector<EmbreeScene::Plan> EmbreeScene::makePlans(const PosedScene& posed, const PosedScene* before) const {
    const Scene& scene = *posed.scene;
    const std::vector<bool> animated = animatedNodes(scene);
    struct Use {
        int count = 0;
        bool hasAlpha = false;
    };
    std::unordered_map<const Mesh*, Use> uses;
    for (const Instance& instance : scene.instances) ++uses[instance.mesh.get()].count;
    for (auto& [mesh, use] : uses) use.hasAlpha = mesh && hasAlpha(scene, *mesh);

    std::vector<Plan> plans(scene.instances.size());
    for (size_t i = 0; i < plans.size(); ++i) {
        const Instance& instance = scene.instances[i];
        const PosedInstance& pose = posed.instances[i];
        const Mesh* mesh = instance.mesh.get();
        Plan& plan = plans[i];
        // What moved once may move again: it stays an instance.
        const bool moved = before && i < plans_.size() && meshOf(*before, i) == mesh &&
                           (plans_[i].mode == Mode::Instanced || plans_[i].mode == Mode::MovingBody);
        const bool moves =
            pose.moves() || moved || (instance.node >= 0 && animated[static_cast<size_t>(instance.node)]);
        if (instance.light >= 0 && hasBody(scene.lights[static_cast<size_t>(instance.light)].type)) {
            plan.mode = moves ? Mode::MovingBody : Mode::Body;
        } else if (mesh && !mesh->triangles.empty()) {
            const Use& use = uses[mesh];
            plan.filtered =
                instance.material >= 0 ? hasAlpha(scene, static_cast<uint32_t>(instance.material)) : use.hasAlpha;
            const bool instanced = pose.deformed || moves || use.count > 1;
            // Of what is flat at some moment the triangles themselves are carried into the world, at each moment.
            plan.inWorld = !instanced || !alwaysCarriesRays(pose);
            plan.mode = pose.deformed || (plan.inWorld && pose.track()) ? Mode::Deforming
                        : plan.inWorld                                  ? Mode::Direct
                                                                        : Mode::Instanced;
            if (instanced && plan.inWorld && isAlwaysSpeck(pose)) plan.mode = Mode::None;
        }
    }
    return plans;
}

/// What decides how instances are attached; a change of it rebuilds the top level.
bool EmbreeScene::sameAttachments(const PosedScene& a, const std::vector<Plan>& plansA, const PosedScene& b,
                                  const std::vector<Plan>& plansB) {
    if (plansA.size() != plansB.size()) return false;
    for (size_t i = 0; i < plansA.size(); ++i) {
        if (plansA[i].mode != plansB[i].mode || plansA[i].filtered != plansB[i].filtered ||
            meshOf(a, i) != meshOf(b, i))
            return false;
        const auto index = static_cast<uint32_t>(i);
        if (plansA[i].mode == Mode::Direct && a.instances[i].worldFromObject != b.instances[i].worldFromObject)
            return false;
        if (plansA[i].mode == Mode::Body && !(Body(a, index).shape == Body(b, index).shape)) return false;
    }
    return true;
}

}  // namespace lumi
