#include "scene/gltf/animations.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "base/error.h"
#include "scene/gltf/accessor.h"
#include "scene/gltf/choices.h"

namespace lumi::gltf {
namespace {

std::optional<AnimatedProperty> propertyOf(const std::string& path) {
    if (path == "translation") return AnimatedProperty::Translation;
    if (path == "rotation") return AnimatedProperty::Rotation;
    if (path == "scale") return AnimatedProperty::Scale;
    if (path == "weights") return AnimatedProperty::MorphWeights;
    return std::nullopt;
}

Interpolation interpolationOf(const Document& document, const std::string& name, const std::string& path) {
    if (name == "STEP") return Interpolation::Step;
    if (name == "CUBICSPLINE") return Interpolation::CubicSpline;
    if (!name.empty() && name != "LINEAR")
        document.fail(path, "no such interpolation", "LINEAR, STEP or CUBICSPLINE", '"' + name.substr(0, 40) + '"');
    return Interpolation::Linear;
}

std::vector<float> readTimes(const Document& document, int accessor, const std::string& path) {
    std::vector<float> times = readFloats(document, accessor, 1, path);
    for (size_t i = 0; i < times.size(); ++i)
        if (!std::isfinite(times[i]) || (i > 0 && times[i] < times[i - 1]))
            document.fail(path, "key " + std::to_string(i) + ": times must be finite and ascend");
    return times;
}

/// A weight for each target of the node's mesh, no more and no less; without targets they move nothing.
void checkWeights(const Document& document, const AnimationChannel& channel, int node, const std::string& path) {
    const int mesh = document.model().nodes[static_cast<size_t>(node)].mesh;
    if (mesh < 0 || document.model().meshes[static_cast<size_t>(mesh)].primitives.empty()) return;
    const size_t targets = document.model().meshes[static_cast<size_t>(mesh)].primitives[0].targets.size();
    if (targets > 0 && targets != static_cast<size_t>(channel.components))
        document.fail(path, "has not one weight a key for each morph target", std::to_string(targets),
                      std::to_string(channel.components));
}

/// One channel, or nothing if it moves nothing of the scene.
std::optional<AnimationChannel> readChannel(const Document& document, const NodeTree& tree,
                                            const tinygltf::Animation& animation, size_t index,
                                            const std::string& path) {
    const tinygltf::AnimationChannel& source = animation.channels[index];
    const std::string channelPath = path + "/channels/" + std::to_string(index);
    const std::optional<AnimatedProperty> property = propertyOf(source.target_path);
    if (!property) document.warn("the animated property \"" + source.target_path.substr(0, 60) + "\" is not supported");
    if (!property || source.target_node < 0) return std::nullopt;
    document.checkIndex(source.target_node, document.model().nodes.size(), channelPath + "/target/node", "nodes");
    document.checkIndex(source.sampler, animation.samplers.size(), channelPath + "/sampler", "samplers");
    const tinygltf::AnimationSampler& sampler = animation.samplers[static_cast<size_t>(source.sampler)];
    const std::string samplerPath = path + "/samplers/" + std::to_string(source.sampler);

    AnimationChannel channel;
    channel.node = tree.nodeOf(static_cast<size_t>(source.target_node));
    channel.property = *property;
    channel.interpolation = interpolationOf(document, sampler.interpolation, samplerPath + "/interpolation");
    channel.times = readTimes(document, sampler.input, samplerPath + "/input");
    if (channel.node < 0 || channel.times.empty()) return std::nullopt;
    const size_t rows = channel.times.size() * (channel.interpolation == Interpolation::CubicSpline ? 3 : 1);
    const int width = *property == AnimatedProperty::MorphWeights ? 1 : *property == AnimatedProperty::Rotation ? 4 : 3;
    channel.values = readFloats(document, sampler.output, width, samplerPath + "/output");
    channel.components = width > 1 ? width : static_cast<int>(channel.values.size() / rows);
    if (channel.components == 0 || channel.values.size() != rows * static_cast<size_t>(channel.components))
        document.fail(samplerPath + "/output", "its count does not fit the keys",
                      width > 1 ? std::to_string(rows) : "a multiple of " + std::to_string(rows),
                      std::to_string(channel.values.size() / static_cast<size_t>(width)));
    if (width == 1) checkWeights(document, channel, source.target_node, samplerPath + "/output");
    for (const float value : channel.values)
        if (!std::isfinite(value)) document.fail(samplerPath + "/output", "a value is not finite");
    return channel;
}

std::string nameOf(const Document& document, size_t animation) {
    const std::string& name = document.model().animations[animation].name;
    return name.empty() ? std::to_string(animation) : name;
}

/// Number of the animation that the options ask for, by name before number; nothing if they do not.
std::optional<size_t> chosenAnimation(const Document& document) {
    const std::string& wanted = document.options().choice.animation;
    if (wanted.empty()) return std::nullopt;
    const size_t count = document.model().animations.size();
    std::vector<std::string> known;
    for (size_t a = 0; a < count; ++a) {
        if (nameOf(document, a) == wanted) return a;
        known.push_back(nameOf(document, a));
    }
    for (size_t a = 0; a < count; ++a)
        if (std::to_string(a) == wanted) return a;
    throwUsage({.what = "no such animation",
                .where = document.path().filename().string(),
                .expected = known.empty() ? "none: the file has no animations" : listedNames(known),
                .found = wanted});
}

}  // namespace

void loadAnimations(const Document& document, const NodeTree& tree, Scene& scene) {
    std::set<std::pair<int, AnimatedProperty>> moved;
    const std::optional<size_t> chosen = chosenAnimation(document);
    std::vector<std::string> notPlayed;
    for (size_t a = 0; a < document.model().animations.size(); ++a) {
        if (a != chosen.value_or(a)) continue;
        const tinygltf::Animation& source = document.model().animations[a];
        const std::string path = "/animations/" + std::to_string(a);
        Animation animation;
        animation.index = static_cast<int>(a);
        bool conflicts = false;
        for (size_t c = 0; c < source.channels.size(); ++c) {
            std::optional<AnimationChannel> channel = readChannel(document, tree, source, c, path);
            if (!channel) continue;
            conflicts |= moved.contains({channel->node, channel->property});
            animation.duration = std::max(animation.duration, channel->times.back());
            if (scene.nodes[static_cast<size_t>(channel->node)].hasMatrix)
                document.warn("an animation moves a node whose matrix is no translation, rotation and scale; it stays");
            animation.channels.push_back(std::move(*channel));
        }
        if (conflicts) {
            notPlayed.push_back(nameOf(document, a));
            continue;
        }
        for (const AnimationChannel& channel : animation.channels) moved.insert({channel.node, channel.property});
        if (!animation.channels.empty()) scene.animations.push_back(std::move(animation));
    }
    if (!notPlayed.empty())
        document.info("what moves the same as an earlier animation is not played: " + listedNames(notPlayed) +
                      "; scene.animation (\"animation\" in a scene file) plays one alone");
}

}  // namespace lumi::gltf
