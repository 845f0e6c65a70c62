#include "scene/gltf/nodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "base/memory.h"
#include "scene/gltf/accessor.h"
#include "scene/gltf/transforms.h"
#include "scene/gltf/values.h"

namespace lumi::gltf {
namespace {

std::string nodePath(size_t index) { return "/nodes/" + std::to_string(index); }

std::string attributesPath(const std::string& nodePath) {
    return nodePath + "/extensions/EXT_mesh_gpu_instancing/attributes";
}

/// For exactly `more` things, or by half of what is there if that is more, so that many small additions move few.
template <class Things>
void makeRoom(Things& things, size_t more) {
    if (things.capacity() - things.size() < more) things.reserve(things.size() + std::max(more, things.size() / 2));
}

/// A number, or the nearest to it from `least` to `most`, with a warning.
float within(const Document& document, double number, float least, float most, const std::string& path) {
    const float given = static_cast<float>(number), taken = std::clamp(given, least, most);
    if (taken != given) document.warn(fmt::format("{}: {:.4g} is out of range; {:.4g} is taken", path, given, taken));
    return taken;
}

}  // namespace

size_t instanceCount(const Document& document, const tinygltf::Value& extension, const std::string& nodePath) {
    const std::string path = attributesPath(nodePath);
    const tinygltf::Value& attributes = extension.Get("attributes");
    if (!attributes.IsObject() || attributes.Keys().empty()) document.fail(path, "names no accessor");
    std::optional<size_t> count;
    for (const std::string& name : attributes.Keys()) {
        const int index = integerOf(attributes, name, -1);
        document.checkIndex(index, document.model().accessors.size(), path + "/" + name, "accessors");
        const size_t own = document.model().accessors[static_cast<size_t>(index)].count;
        if (own != count.value_or(own))
            document.fail(path + "/" + name, "has another count than the others", std::to_string(*count),
                          std::to_string(own));
        count = own;
    }
    return *count;
}

NodeTree::NodeTree(const Document& document, Scene& scene)
    : document_(document),
      scene_(scene),
      nodeOf_(document.model().nodes.size(), -1),
      usedMeshes_(document.model().meshes.size(), false),
      skinOf_(document.model().skins.size(), -1) {
    const tinygltf::Model& model = document.model();
    for (size_t i = 0; i < model.nodes.size(); ++i)
        for (size_t c = 0; c < model.nodes[i].children.size(); ++c)
            document.checkIndex(model.nodes[i].children[c], model.nodes.size(),
                                nodePath(i) + "/children/" + std::to_string(c), "nodes");
    for (const int root : roots()) walk(root, nodePath(static_cast<size_t>(root)));

    // Joints may lie outside the scene's tree: they come along, without their meshes.
    const std::vector<int> shown = order_;
    std::vector<bool> isKnown(model.skins.size(), false);
    std::vector<int> parentOf(model.nodes.size(), -1);
    for (size_t i = 0; i < model.nodes.size(); ++i)
        for (const int child : model.nodes[i].children) parentOf[static_cast<size_t>(child)] = static_cast<int>(i);
    for (const int node : shown) {
        const int skin = model.nodes[static_cast<size_t>(node)].skin;
        if (skin < 0 || isKnown[static_cast<size_t>(skin)]) continue;
        isKnown[static_cast<size_t>(skin)] = true;
        for (const int joint : model.skins[static_cast<size_t>(skin)].joints) {
            document.checkIndex(joint, model.nodes.size(), "/skins/" + std::to_string(skin) + "/joints", "nodes");
            int top = joint;
            for (size_t steps = 0; parentOf[static_cast<size_t>(top)] >= 0 && nodeOf_[static_cast<size_t>(top)] < 0;
                 ++steps) {
                if (steps > model.nodes.size())
                    document.fail(nodePath(static_cast<size_t>(joint)), "is its own ancestor");
                top = parentOf[static_cast<size_t>(top)];
            }
            if (nodeOf_[static_cast<size_t>(top)] < 0) walk(top, nodePath(static_cast<size_t>(top)));
        }
    }
    order_ = shown;
    for (const int node : order_) {
        const int mesh = model.nodes[static_cast<size_t>(node)].mesh;
        if (mesh >= 0) usedMeshes_[static_cast<size_t>(mesh)] = true;
    }
}

std::vector<int> NodeTree::roots() const {
    const tinygltf::Model& model = document_.model();
    const int wanted = document_.options().choice.index;
    if (wanted >= static_cast<int>(model.scenes.size()))
        throwUsage({.what = "no such scene in the file",
                    .where = document_.path().filename().string(),
                    .expected = "below " + std::to_string(model.scenes.size()),
                    .found = std::to_string(wanted)});
    if (model.scenes.empty()) {
        std::vector<bool> isChild(model.nodes.size(), false);
        for (const tinygltf::Node& node : model.nodes)
            for (const int child : node.children) isChild[static_cast<size_t>(child)] = true;
        std::vector<int> all;
        for (size_t i = 0; i < model.nodes.size(); ++i)
            if (!isChild[i]) all.push_back(static_cast<int>(i));
        return all;
    }
    const int index = wanted >= 0 ? wanted : std::max(model.defaultScene, 0);
    document_.checkIndex(index, model.scenes.size(), "/scene", "scenes");
    const std::vector<int>& nodes = model.scenes[static_cast<size_t>(index)].nodes;
    for (size_t i = 0; i < nodes.size(); ++i)
        document_.checkIndex(nodes[i], model.nodes.size(),
                             "/scenes/" + std::to_string(index) + "/nodes/" + std::to_string(i), "nodes");
    return nodes;
}

void NodeTree::walk(int root, const std::string& rootPath) {
    struct Visit {
        int node, parent;
    };
    std::vector<Visit> stack{{root, -1}};
    while (!stack.empty()) {
        const Visit visit = stack.back();
        stack.pop_back();
        if (nodeOf_[static_cast<size_t>(visit.node)] >= 0)
            document_.fail(nodePath(static_cast<size_t>(visit.node)),
                           "is reached twice from " + rootPath + ": it is its own ancestor or has two parents");
        addNode(visit.node, visit.parent);
        const std::vector<int>& children = document_.model().nodes[static_cast<size_t>(visit.node)].children;
        const int parent = nodeOf_[static_cast<size_t>(visit.node)];
        for (size_t c = children.size(); c-- > 0;) stack.push_back({children[c], parent});
    }
}

void NodeTree::checkReferences(const tinygltf::Node& node, const std::string& path) const {
    const tinygltf::Model& model = document_.model();
    if (node.mesh >= 0) document_.checkIndex(node.mesh, model.meshes.size(), path + "/mesh", "meshes");
    if (node.skin >= 0) document_.checkIndex(node.skin, model.skins.size(), path + "/skin", "skins");
    if (node.camera >= 0) document_.checkIndex(node.camera, model.cameras.size(), path + "/camera", "cameras");
    if (const auto* extension = extensionOf(node.extensions, "KHR_lights_punctual"))
        document_.checkIndex(integerOf(*extension, "light", -1), model.lights.size(),
                             path + "/extensions/KHR_lights_punctual/light", "extensions/KHR_lights_punctual/lights");
}

void NodeTree::addNode(int index, int parent) {
    const tinygltf::Node& source = document_.model().nodes[static_cast<size_t>(index)];
    checkReferences(source, nodePath(static_cast<size_t>(index)));
    Node node;
    node.name = source.name.empty() ? "node-" + std::to_string(index) : source.name;
    node.parent = parent;
    readTransform(document_, source, nodePath(static_cast<size_t>(index)), node);
    std::vector<double> weights = source.weights;
    if (weights.empty() && source.mesh >= 0)
        weights = document_.model().meshes[static_cast<size_t>(source.mesh)].weights;
    for (const double weight : weights)
        node.morphWeights.push_back(std::isfinite(weight) ? static_cast<float>(weight) : 0);
    nodeOf_[static_cast<size_t>(index)] = static_cast<int>(scene_.nodes.size());
    order_.push_back(index);
    scene_.nodes.push_back(std::move(node));
}

void NodeTree::populate(const std::vector<std::shared_ptr<const Mesh>>& meshes) {
    meshes_ = meshes;
    for (const int index : order_) {
        addInstances(static_cast<size_t>(index));
        addCamera(static_cast<size_t>(index));
        addLight(static_cast<size_t>(index));
    }
}

void NodeTree::addInstances(size_t index) {
    const tinygltf::Node& source = document_.model().nodes[index];
    if (source.mesh < 0 || !meshes_[static_cast<size_t>(source.mesh)]) return;
    Instance instance;
    instance.mesh = meshes_[static_cast<size_t>(source.mesh)];
    instance.name = source.name.empty() ? instance.mesh->name : source.name;
    instance.node = nodeOf_[index];
    if (source.skin >= 0 && !instance.mesh->skin.empty()) {
        instance.skin = addSkin(source.skin);
        checkJoints(instance, nodePath(index) + "/skin");
    }
    if (const auto* extension = extensionOf(source.extensions, "EXT_mesh_gpu_instancing"))
        addGpuInstances(index, instance, *extension);
    else scene_.instances.push_back(instance);
}

void NodeTree::addGpuInstances(size_t index, const Instance& prototype, const tinygltf::Value& extension) {
    const std::string path = attributesPath(nodePath(index));
    const size_t count = instanceCount(document_, extension, nodePath(index));
    const tinygltf::Value& attributes = extension.Get("attributes");
    std::vector<Vec3> translations, scales;
    std::vector<Vec4> rotations;
    const auto read = [&](const char* name, auto& values) {
        using T = typename std::remove_reference_t<decltype(values)>::value_type;
        const int accessor = integerOf(attributes, name, -1);
        if (accessor < 0) return;
        values = readVectors<T>(document_, accessor, path + "/" + name);
    };
    read("TRANSLATION", translations);
    read("ROTATION", rotations);
    read("SCALE", scales);
    const size_t weights = scene_.nodes[static_cast<size_t>(prototype.node)].morphWeights.size();
    checkMemory("instances", (scene_.nodes.size() + count) * sizeof(Node) + count * weights * sizeof(float) +
                                 (scene_.instances.size() + count) * sizeof(Instance));
    makeRoom(scene_.nodes, count);
    makeRoom(scene_.instances, count);
    for (size_t i = 0; i < count; ++i) {
        if (i % 4096 == 0) document_.pollStop();
        Node node;
        node.parent = prototype.node;
        node.sharesMorphWeights = true;
        if (!translations.empty()) node.local.translation = translations[i];
        if (!rotations.empty()) node.local.rotation = unitRotation(rotations[i]);
        if (!scales.empty()) node.local.scale = scales[i];
        if (!isFinite(node.local.translation) || !isFinite(node.local.scale))
            document_.fail(path, "instance " + std::to_string(i) + " has a transform that is not finite");
        Instance instance = prototype;
        instance.name = prototype.name + "-" + std::to_string(i);
        instance.node = static_cast<int>(scene_.nodes.size());
        scene_.nodes.push_back(std::move(node));
        scene_.instances.push_back(std::move(instance));
    }
}

int NodeTree::addSkin(int index) {
    int& mapped = skinOf_[static_cast<size_t>(index)];
    if (mapped >= 0) return mapped;
    const tinygltf::Skin& source = document_.model().skins[static_cast<size_t>(index)];
    const std::string path = "/skins/" + std::to_string(index);
    Skin skin;
    for (const int joint : source.joints) skin.joints.push_back(nodeOf_[static_cast<size_t>(joint)]);
    if (source.inverseBindMatrices >= 0)
        skin.inverseBind = readVectors<Mat4>(document_, source.inverseBindMatrices, path + "/inverseBindMatrices");
    else skin.inverseBind.assign(skin.joints.size(), Mat4(1));
    if (skin.inverseBind.size() < skin.joints.size())
        document_.fail(path + "/inverseBindMatrices", "fewer matrices than joints", std::to_string(skin.joints.size()),
                       std::to_string(skin.inverseBind.size()));
    skin.inverseBind.resize(skin.joints.size());
    for (const Mat4& m : skin.inverseBind)
        if (!isFiniteMatrix(m)) document_.fail(path + "/inverseBindMatrices", "a matrix is not finite");
    mapped = static_cast<int>(scene_.skins.size());
    scene_.skins.push_back(std::move(skin));
    return mapped;
}

void NodeTree::checkJoints(const Instance& instance, const std::string& jsonPath) const {
    const std::vector<uint32_t>& joints = instance.mesh->skin.joint;
    const uint32_t largest = *std::max_element(joints.begin(), joints.end());
    const size_t count = scene_.skins[static_cast<size_t>(instance.skin)].joints.size();
    if (largest >= count)
        document_.fail(jsonPath, "the mesh refers to a joint that the skin does not have",
                       "below " + std::to_string(count), std::to_string(largest));
}

void NodeTree::addCamera(size_t index) {
    const tinygltf::Node& source = document_.model().nodes[index];
    if (source.camera < 0) return;
    const tinygltf::Camera& camera = document_.model().cameras[static_cast<size_t>(source.camera)];
    const std::string path = "/cameras/" + std::to_string(source.camera);
    SceneCamera placed;
    placed.node = nodeOf_[index];
    placed.camera.name = !camera.name.empty()   ? camera.name
                         : !source.name.empty() ? source.name
                                                : "camera-" + std::to_string(source.camera);
    if (camera.type == "orthographic") {
        placed.camera.projection = Projection::Orthographic;
        placed.camera.yMag = within(document_, camera.orthographic.ymag, 1e-4f, 1e9f, path + "/orthographic/ymag");
    } else {
        placed.camera.fovYDeg =
            degrees(within(document_, camera.perspective.yfov, radians(1), radians(170), path + "/perspective/yfov"));
    }
    scene_.cameras.push_back(std::move(placed));
}

void NodeTree::addLight(size_t index) {
    const auto* extension = extensionOf(document_.model().nodes[index].extensions, "KHR_lights_punctual");
    if (!extension) return;
    const int number = integerOf(*extension, "light", -1);
    const tinygltf::Light& source = document_.model().lights[static_cast<size_t>(number)];
    Light light;
    light.name = !source.name.empty() ? source.name : "light-" + std::to_string(number);
    light.node = nodeOf_[index];
    const float intensity = std::isfinite(source.intensity) ? std::max(0.0f, static_cast<float>(source.intensity)) : 0;
    const Vec3 emitted = glm::max(vec3From(source.color, Vec3(1)), Vec3(0)) * intensity;
    light.intensity = light.irradiance = emitted;
    if (source.range > 0 && std::isfinite(source.range)) light.range = static_cast<float>(source.range);
    if (source.type == "directional") {
        light.type = LightType::Directional;
    } else if (source.type == "spot") {
        light.type = LightType::Spot;
        light.outerConeDeg = std::clamp(degrees(static_cast<float>(source.spot.outerConeAngle)), 0.01f, 90.0f);
        light.innerConeDeg =
            std::clamp(degrees(static_cast<float>(source.spot.innerConeAngle)), 0.0f, light.outerConeDeg);
    }
    if (source.type != "directional" && source.type != "spot" && source.type != "point")
        document_.fail("/extensions/KHR_lights_punctual/lights/" + std::to_string(number) + "/type",
                       "no such type of light", "directional, point or spot", '"' + source.type.substr(0, 40) + '"');
    scene_.lights.push_back(std::move(light));
}

}  // namespace lumi::gltf
