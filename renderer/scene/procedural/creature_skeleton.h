#pragma once
#include <array>

#include "scene/procedural/generators.h"

namespace lumi::creature {

/// Joints of the skeleton, parents first. The spine runs from the tail's tip to the head along +Z.
enum Joint { kPelvis, kChest, kNeckLow, kNeckHigh, kHead, kTail1, kTail2, kTail3, kTail4, kFirstLeg };
constexpr int kJointsPerLeg = 3, kLegs = 4, kJoints = kFirstLeg + kJointsPerLeg * kLegs;

/// Weights of all joints for one vertex.
using Influences = std::array<float, kJoints>;

/// Places at rest in the asset's space, for a creature of length 1. Legs: front left, front right, hind left, hind
/// right.
Vec3 restPosition(int joint);
Vec3 legRoot(int leg);
Vec3 legKnee(int leg);
Vec3 legAnkle(int leg);
int parentOf(int joint);

/// All weight on one joint.
Influences only(int joint);
/// Weights at `s` along the spine: 0 is the tail's tip, 1 the nose.
Influences alongSpine(float s);

/// How the creature walks.
struct Gait {
    float period = 1;      ///< seconds for one cycle
    float phase = 0;       ///< where in the cycle it starts
    float strideDeg = 22;  ///< half the angle through which the legs swing
};

/// Adds the nodes and the skin, then the looping animation, for a creature of `length` metres.
void addSkeleton(ProceduralResult& result, float length);
void addGait(ProceduralResult& result, float length, const Gait& gait);

}  // namespace lumi::creature
