#include "scene/procedural/creature_skeleton.h"

#include <algorithm>

namespace lumi::creature {
namespace {

struct JointRest {
    const char* name;
    int parent;
    Vec3 position;  ///< in the asset's space at rest, for a creature of length 1
};

constexpr std::array<JointRest, kFirstLeg> kSpine = {{{"pelvis", -1, {0, 0.46f, -0.12f}},
                                                      {"chest", kPelvis, {0, 0.47f, 0.12f}},
                                                      {"neck-low", kChest, {0, 0.56f, 0.27f}},
                                                      {"neck-high", kNeckLow, {0, 0.70f, 0.34f}},
                                                      {"head", kNeckHigh, {0, 0.82f, 0.40f}},
                                                      {"tail-1", kPelvis, {0, 0.45f, -0.28f}},
                                                      {"tail-2", kTail1, {0, 0.41f, -0.42f}},
                                                      {"tail-3", kTail2, {0, 0.38f, -0.55f}},
                                                      {"tail-4", kTail3, {0, 0.37f, -0.67f}}}};

/// Where along the spine curve (0 tail tip, 1 nose) each spine joint acts.
constexpr std::array<std::pair<int, float>, 9> kSpineOrder = {{{kTail4, 0.10f},
                                                               {kTail3, 0.20f},
                                                               {kTail2, 0.30f},
                                                               {kTail1, 0.40f},
                                                               {kPelvis, 0.51f},
                                                               {kChest, 0.64f},
                                                               {kNeckLow, 0.75f},
                                                               {kNeckHigh, 0.84f},
                                                               {kHead, 0.91f}}};

}  // namespace

Vec3 legRoot(int leg) {
    const float side = leg % 2 == 0 ? -1.0f : 1.0f;
    return leg < 2 ? Vec3(side * 0.095f, 0.42f, 0.14f) : Vec3(side * 0.105f, 0.42f, -0.14f);
}
Vec3 legKnee(int leg) { return legRoot(leg) + Vec3((leg % 2 == 0 ? -1 : 1) * 0.02f, -0.19f, leg < 2 ? -0.01f : 0.03f); }
Vec3 legAnkle(int leg) { return legKnee(leg) + Vec3(0, -0.18f, leg < 2 ? 0.01f : -0.03f); }

Vec3 restPosition(int joint) {
    if (joint < kFirstLeg) return kSpine[static_cast<size_t>(joint)].position;
    const int leg = (joint - kFirstLeg) / kJointsPerLeg;
    const int part = (joint - kFirstLeg) % kJointsPerLeg;
    return part == 0 ? legRoot(leg) : part == 1 ? legKnee(leg) : legAnkle(leg);
}
int parentOf(int joint) {
    if (joint < kFirstLeg) return kSpine[static_cast<size_t>(joint)].parent;
    const int leg = (joint - kFirstLeg) / kJointsPerLeg;
    if ((joint - kFirstLeg) % kJointsPerLeg == 0) return leg < 2 ? kChest : kPelvis;
    return joint - 1;
}

Influences only(int joint) {
    Influences w{};
    w[static_cast<size_t>(joint)] = 1;
    return w;
}

Influences alongSpine(float s) {
    Influences w{};
    if (s <= kSpineOrder.front().second) return only(kSpineOrder.front().first);
    for (size_t i = 1; i < kSpineOrder.size(); ++i)
        if (s <= kSpineOrder[i].second) {
            const float t = glm::smoothstep(kSpineOrder[i - 1].second, kSpineOrder[i].second, s);
            w[static_cast<size_t>(kSpineOrder[i - 1].first)] = 1 - t;
            w[static_cast<size_t>(kSpineOrder[i].first)] = t;
            return w;
        }
    return only(kSpineOrder.back().first);
}

void addSkeleton(ProceduralResult& result, float length) {
    Skin skin;
    for (int joint = 0; joint < kJoints; ++joint) {
        Node node;
        node.name =
            joint < kFirstLeg ? kSpine[static_cast<size_t>(joint)].name : "leg-" + std::to_string(joint - kFirstLeg);
        node.parent = parentOf(joint);
        const Vec3 origin = node.parent >= 0 ? restPosition(node.parent) : Vec3(0);
        node.local.translation = (restPosition(joint) - origin) * length;
        result.nodes.push_back(std::move(node));
        skin.joints.push_back(joint);
        skin.inverseBind.push_back(Transform{-restPosition(joint) * length, {1, 0, 0, 0}, Vec3(1)}.matrix());
    }
    result.skins.push_back(std::move(skin));
}

/// Every joint swings in sines of the cycle; keys are dense enough for linear interpolation.
void addGait(ProceduralResult& result, float length, const Gait& gait) {
    constexpr int kKeys = 24;
    Animation walk;
    walk.duration = gait.period;
    const auto rotation = [&](int joint, const std::function<Vec3(float)>& eulerDeg) {
        AnimationChannel channel;
        channel.node = joint;
        channel.property = AnimatedProperty::Rotation;
        channel.components = 4;
        for (int k = 0; k <= kKeys; ++k) {
            const float t = static_cast<float>(k % kKeys) / kKeys;
            const Vec3 e = eulerDeg(2 * kPi * (t + gait.phase));
            const Quat q = glm::angleAxis(radians(e.y), Vec3(0, 1, 0)) * glm::angleAxis(radians(e.x), Vec3(1, 0, 0)) *
                           glm::angleAxis(radians(e.z), Vec3(0, 0, 1));
            channel.times.push_back(gait.period * static_cast<float>(k) / kKeys);
            channel.values.insert(channel.values.end(), {q.x, q.y, q.z, q.w});
        }
        walk.channels.push_back(std::move(channel));
    };
    AnimationChannel bob;
    bob.node = kPelvis;
    bob.property = AnimatedProperty::Translation;
    bob.components = 3;
    for (int k = 0; k <= kKeys; ++k) {
        const float w = 2 * kPi * (static_cast<float>(k % kKeys) / kKeys + gait.phase);
        const Vec3 p =
            (restPosition(kPelvis) + Vec3(0.006f * std::sin(w), 0.010f * std::cos(2 * w) - 0.012f, 0)) * length;
        bob.times.push_back(gait.period * static_cast<float>(k) / kKeys);
        bob.values.insert(bob.values.end(), {p.x, p.y, p.z});
    }
    walk.channels.push_back(std::move(bob));
    rotation(kPelvis, [](float w) { return Vec3(1.5f * std::cos(2 * w), 4 * std::sin(w), 3 * std::sin(w)); });
    rotation(kChest, [](float w) { return Vec3(-1.5f * std::cos(2 * w), -7 * std::sin(w), -4 * std::sin(w)); });
    rotation(kNeckLow, [](float w) { return Vec3(4 * std::sin(2 * w), 4 * std::sin(w + 0.6f), 0); });
    rotation(kNeckHigh, [](float w) { return Vec3(-3 * std::sin(2 * w + 0.5f), 5 * std::sin(w + 0.9f), 0); });
    rotation(kHead, [](float w) { return Vec3(-5 * std::sin(2 * w + 0.2f), 4 * std::sin(w), 0); });
    for (int i = 0; i < 4; ++i)
        rotation(kTail1 + i, [i](float w) {
            return Vec3(2 * std::sin(2 * w),
                        (7 + 3 * static_cast<float>(i)) * std::sin(w - 0.7f * static_cast<float>(i)), 0);
        });
    constexpr std::array<float, kLegs> kLead = {0, 0.5f, 0.75f, 0.25f};
    for (int leg = 0; leg < kLegs; ++leg) {
        const float lead = 2 * kPi * kLead[static_cast<size_t>(leg)], swing = gait.strideDeg;
        const int hip = kFirstLeg + leg * kJointsPerLeg;
        // The foot goes back on the ground while sin falls and is lifted while it swings forward.
        const auto lift = [lead](float w) { return std::pow(std::max(0.0f, std::cos(w + lead)), 1.3f); };
        rotation(hip, [=](float w) { return Vec3(-swing * std::sin(w + lead) - 12 * lift(w), 0, 0); });
        rotation(hip + 1, [=](float w) { return Vec3(38 * lift(w), 0, 0); });
        rotation(hip + 2, [=](float w) { return Vec3(swing * 0.8f * std::sin(w + lead) - 18 * lift(w), 0, 0); });
    }
    result.animations.push_back(std::move(walk));
}

}  // namespace lumi::creature
