#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "scene/scene_file_parts.h"

namespace lumi {
namespace {

/// One key of an object's motion: only what it mentions is animated by it.
struct PlacementKey {
    float time = 0;
    std::optional<Vec3> translation, rotateDeg, scale, target, direction;
};

Vec3 readScale(ObjectReader& reader, const JsonValue& value) {
    const Vec3 scale = value.isNumber() ? Vec3(static_cast<float>(readNumber(reader.tree(), value, "scale", -1e6, 1e6)))
                                        : readVector(reader.tree(), value, "scale");
    if (scale.x == 0 || scale.y == 0 || scale.z == 0) refuseValue(reader.tree(), value, "scale", "no zero");
    return scale;
}

PlacementKey readPlacementKey(ObjectReader& reader, PlacementKeys keys) {
    PlacementKey key;
    key.translation = reader.vector("translate");
    key.rotateDeg = reader.vector("rotate-deg");
    if (keys.scale)
        if (const JsonValue* scale = reader.find("scale")) key.scale = readScale(reader, *scale);
    if (!keys.look) return key;
    key.target = reader.vector("look-at");
    key.direction = reader.vector("direction");
    const int ways = key.rotateDeg.has_value() + key.target.has_value() + key.direction.has_value();
    if (ways > 1)
        reader.fail(reader.value().at, fmt::format("\"{}\" is turned in two ways", reader.name()),
                    "one of \"rotate-deg\", \"look-at\" and \"direction\"");
    if (key.direction && glm::length(*key.direction) == 0)
        refuseValue(reader.tree(), *reader.find("direction"), "direction", "a vector that is not zero");
    return key;
}

/// Rotation that a key asks for at a place, if it says anything of it.
std::optional<Quat> rotationOf(const PlacementKey& key, const Vec3& place) {
    if (key.rotateDeg) return rotationFromDegrees(*key.rotateDeg);
    if (key.target) return glm::normalize(glm::quat_cast(Mat3(lookAt(place, *key.target))));
    if (key.direction) return glm::normalize(glm::quat_cast(Mat3(lookAt(Vec3(0), *key.direction))));
    return {};
}

/// One property over time while its keys are collected.
class ChannelBuilder {
public:
    ChannelBuilder(int node, AnimatedProperty property, Interpolation interpolation) {
        channel_.node = node;
        channel_.property = property;
        channel_.interpolation = interpolation;
        channel_.components = property == AnimatedProperty::Rotation ? 4 : 3;
    }
    void add(float time, const Vec3& v) { append(time, {v.x, v.y, v.z}); }
    void add(float time, const Quat& q) { append(time, {q.x, q.y, q.z, q.w}); }
    void finish(Animation& animation) {
        if (channel_.times.empty()) return;
        animation.duration = std::max(animation.duration, channel_.times.back());
        animation.channels.push_back(std::move(channel_));
    }

private:
    void append(float time, std::initializer_list<float> values) {
        channel_.times.push_back(time);
        channel_.values.insert(channel_.values.end(), values);
    }
    AnimationChannel channel_;
};

/// Adds the turn from `from` to `to` degrees. Quaternions take the shorter way, so turns of half a circle and more are
/// cut into quarters: they go the way the numbers say, as often as they say.
void addTurn(ChannelBuilder& channel, float fromTime, float toTime, const Vec3& from, const Vec3& to, bool stepped) {
    const Vec3 turn = glm::abs(to - from);
    const int pieces =
        stepped || maxComponent(turn) < 179.5f ? 1 : static_cast<int>(std::ceil(maxComponent(turn) / 90));
    for (int i = 1; i <= pieces; ++i) {
        const float t = static_cast<float>(i) / static_cast<float>(pieces);
        channel.add(i == pieces ? toTime : glm::mix(fromTime, toTime, t), rotationFromDegrees(glm::mix(from, to, t)));
    }
}

void addRotationKeys(ChannelBuilder& channel, const std::vector<PlacementKey>& keys, const PlacementKey& rest,
                     const Transform& restTransform, bool stepped) {
    // A lamp that follows a target turns while it moves: what the object itself says holds at keys that say nothing.
    const bool follows = rest.target.has_value();
    Vec3 place = restTransform.translation;
    const PlacementKey* previous = nullptr;
    for (const PlacementKey& key : keys) {
        place = key.translation.value_or(place);
        if (previous && key.rotateDeg && previous->rotateDeg) {
            addTurn(channel, previous->time, key.time, *previous->rotateDeg, *key.rotateDeg, stepped);
        } else if (const auto rotation = rotationOf(key, place)) {
            channel.add(key.time, *rotation);
        } else if (follows && key.translation) {
            channel.add(key.time, *rotationOf(rest, place));
        }
        if (key.rotateDeg || key.target || key.direction) previous = &key;
    }
}

}  // namespace

Quat rotationFromDegrees(const Vec3& degrees) {
    const Quat x = glm::angleAxis(radians(degrees.x), Vec3(1, 0, 0));
    const Quat y = glm::angleAxis(radians(degrees.y), Vec3(0, 1, 0));
    const Quat z = glm::angleAxis(radians(degrees.z), Vec3(0, 0, 1));
    return glm::normalize(z * y * x);
}

Interpolation readInterpolation(ObjectReader& reader, Interpolation fallback) {
    const JsonValue* value = reader.find("interpolation");
    if (!value) return fallback;
    if (value->isString() && value->text == "step") return Interpolation::Step;
    if (value->isString() && value->text == "linear") return Interpolation::Linear;
    if (value->isString() && value->text == "catmull-rom") return Interpolation::CatmullRom;
    refuseValue(reader.tree(), *value, "interpolation", "\"step\", \"linear\" or \"catmull-rom\"");
}

float readKeyTime(ObjectReader& key, std::optional<float> previous) {
    const JsonValue& value = key.need("time");
    const auto time = static_cast<float>(readNumber(key.tree(), value, "time", 0, 1e6));
    if (previous && time <= *previous)
        refuseValue(key.tree(), value, "time", fmt::format("more than the previous key's {:g}", *previous));
    return time;
}

void readPlacement(SceneFileContext& context, ObjectReader& reader, int nodeIndex, PlacementKeys kinds) {
    const PlacementKey rest = readPlacementKey(reader, kinds);
    Transform& local = context.scene.nodes[static_cast<size_t>(nodeIndex)].local;
    local.translation = rest.translation.value_or(Vec3(0));
    local.rotation = rotationOf(rest, local.translation).value_or(Quat(1, 0, 0, 0));
    local.scale = rest.scale.value_or(Vec3(1));

    const Interpolation interpolation = readInterpolation(reader, Interpolation::Linear);
    const bool loop = reader.toggle("loop").value_or(true);
    const JsonValue* list = reader.find("keys");
    if (!list) return;
    if (!list->isArray()) refuseValue(context.tree, *list, "keys", "an array");
    std::vector<PlacementKey> keys;
    for (const JsonValue& item : list->items) {
        ObjectReader key(context.tree, item, "keys");
        const float time = readKeyTime(key, keys.empty() ? std::nullopt : std::optional(keys.back().time));
        keys.push_back(readPlacementKey(key, kinds));
        keys.back().time = time;
        key.finish();
    }

    Animation animation;
    animation.loop = loop;
    ChannelBuilder translation(nodeIndex, AnimatedProperty::Translation, interpolation);
    ChannelBuilder rotation(nodeIndex, AnimatedProperty::Rotation, interpolation);
    ChannelBuilder scale(nodeIndex, AnimatedProperty::Scale, interpolation);
    for (const PlacementKey& key : keys) {
        if (key.translation) translation.add(key.time, *key.translation);
        if (key.scale) scale.add(key.time, *key.scale);
    }
    addRotationKeys(rotation, keys, rest, local, interpolation == Interpolation::Step);
    translation.finish(animation);
    rotation.finish(animation);
    scale.finish(animation);
    if (!animation.channels.empty()) context.scene.animations.push_back(std::move(animation));
}

}  // namespace lumi
