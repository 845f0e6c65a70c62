#include "scene/posed_scene.h"

#include <gtest/gtest.h>

#include <tuple>

#include "base/parallel.h"
#include "scene/deform.h"
#include "scene/node_pose.h"
#include "support/expect_error.h"
#include "support/memory_limit.h"

namespace lumi {
namespace {

void expectNear(const Vec3& a, const Vec3& b, float tolerance = 1e-5f) {
    EXPECT_LT(glm::length(a - b), tolerance)
        << a.x << ' ' << a.y << ' ' << a.z << " against " << b.x << ' ' << b.y << ' ' << b.z;
}

Quat aroundZ(float angleDeg) { return glm::angleAxis(radians(angleDeg), Vec3(0, 0, 1)); }

/// A ladder of vertices along +X at 0, 1, 2 with flat triangles between.
std::shared_ptr<Mesh> bar() {
    auto mesh = std::make_shared<Mesh>();
    mesh->positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    mesh->normals.assign(3, {0, 1, 0});
    mesh->tangents.assign(3, {1, 0, 0, 1});
    mesh->triangles = {{0, 1, 2}};
    return mesh;
}

Node node(int parent, const Vec3& translation, const Quat& rotation = Quat(1, 0, 0, 0), const Vec3& scale = Vec3(1)) {
    Node n;
    n.parent = parent;
    n.local = {translation, rotation, scale};
    return n;
}

/// One translation channel along X from 0 at time 0 to 10 at time 1, on node 0.
Animation sliding() {
    AnimationChannel channel;
    channel.node = 0;
    channel.times = {0, 1};
    channel.values = {0, 0, 0, 10, 0, 0};
    return {{channel}, 1, true};
}

std::shared_ptr<Scene> slidingScene() {
    auto scene = std::make_shared<Scene>();
    scene->materials.resize(1);
    scene->nodes = {node(-1, {0, 0, 0}), node(0, {0, 1, 0})};
    Instance instance;
    instance.mesh = bar();
    instance.node = 1;
    scene->instances = {instance};
    scene->animations = {sliding()};
    return scene;
}

TEST(Pose, WorldMatricesMultiplyDownTheTree) {
    Scene scene;
    scene.nodes = {node(-1, {1, 0, 0}), node(0, {0, 2, 0}, aroundZ(90)), node(1, {3, 0, 0}, aroundZ(0), Vec3(2))};
    const NodePose pose = poseNodes(scene, {});
    expectNear(transformPoint(pose.worldFromNode[2], {1, 0, 0}), {1, 2 + 3 + 2, 0});
    for (int i = 0; i < 3; ++i) EXPECT_EQ(worldFromNodeAt(scene, i, {}), pose.worldFromNode[static_cast<size_t>(i)]);
}

TEST(Pose, MatricesThatAreNoTransformAreKept) {
    Scene scene;
    Node sheared = node(-1, {0, 0, 0});
    sheared.hasMatrix = true;
    sheared.matrix[1].x = 0.5f;
    scene.nodes = {sheared, node(0, {0, 2, 0})};
    expectNear(transformPoint(poseNodes(scene, {}).worldFromNode[1], {0, 0, 0}), {1, 2, 0});
}

TEST(Pose, MirroredNodesFlipHandednessButNotNormals) {
    auto scene = std::make_shared<Scene>();
    scene->nodes = {node(-1, {0, 0, 0}, Quat(1, 0, 0, 0), {-1, 1, 1})};
    scene->materials.resize(1);
    Instance instance;
    instance.mesh = bar();
    instance.node = 0;
    scene->instances = {instance};
    const auto posed = poseScene(scene, {});
    EXPECT_TRUE(isMirroring(posed->instances[0].worldFromObject));
    expectNear(glm::normalize(posed->instances[0].normalFromObject() * Vec3(0, 1, 0)), {0, 1, 0});
    expectNear(posed->bounds.lower, {-2, 0, 0});
}

TEST(Pose, ThreeMomentsOfRigidMotion) {
    const auto scene = slidingScene();
    const auto posed = poseScene(scene, {.open = 0.5f, .close = 0.6f, .previousOpen = 0.4f});
    const PosedInstance& instance = posed->instances[0];
    expectNear(Vec3(instance.worldFromObject[3]), {5, 1, 0});
    expectNear(Vec3(instance.worldFromObjectClose()[3]), {6, 1, 0});
    expectNear(Vec3(instance.worldFromObjectPrevious()[3]), {4, 1, 0});
    EXPECT_TRUE(instance.moves());
    EXPECT_TRUE(posed->anythingMoves);
    const auto cut = poseScene(scene, {.open = 0.5f, .close = 0.5f, .previousOpen = 0.5f});
    EXPECT_FALSE(cut->instances[0].moves());
    EXPECT_FALSE(cut->anythingMoves);
}

TEST(Pose, ThePreviousFrameIsWhatWasShown) {
    const auto scene = slidingScene();
    const auto before = poseScene(scene, {.open = 0.4f, .close = 0.4f, .previousOpen = 0.4f});
    // A user moved the child up by 5 between the two frames.
    auto edited = std::make_shared<Scene>(*scene);
    edited->nodes[1].local.translation.y = 6;
    const auto after = poseScene(edited, {.open = 0.5f, .close = 0.5f, .previousOpen = 0.4f}, before.get());
    expectNear(Vec3(after->instances[0].worldFromObject[3]), {5, 6, 0});
    expectNear(Vec3(after->instances[0].worldFromObjectPrevious()[3]), {4, 1, 0});
    EXPECT_EQ(after->meshBounds, before->meshBounds);
    const auto elsewhere = poseScene(scene, {.open = 0.5f, .close = 0.5f, .previousOpen = 0.3f}, before.get());
    expectNear(Vec3(elsewhere->instances[0].worldFromObjectPrevious()[3]), {3, 1, 0});
}

/// The bar bound to two joints at x = 0 and x = 1; the second bends by an angle that animation gives.
std::shared_ptr<Scene> bendingScene() {
    auto scene = std::make_shared<Scene>();
    scene->materials.resize(1);
    scene->nodes = {node(-1, {0, 0, 0}), node(0, {1, 0, 0}), node(-1, {100, 0, 0})};
    auto mesh = bar();
    mesh->skin = {{0, 1, 3, 4}, {0, 0, 1, 1}, {1, 0.5f, 0.5f, 1}};
    Instance instance;
    instance.mesh = mesh;
    instance.node = 2;
    instance.skin = 0;
    scene->instances = {instance};
    Mat4 secondInverse(1);
    secondInverse[3] = {-1, 0, 0, 1};
    scene->skins = {{{0, 1}, {Mat4(1), secondInverse}}};
    AnimationChannel bend;
    bend.node = 1;
    bend.property = AnimatedProperty::Rotation;
    bend.components = 4;
    bend.times = {0, 1};
    const Quat q = aroundZ(90);
    bend.values = {0, 0, 0, 1, q.x, q.y, q.z, q.w};
    scene->animations = {{{bend}, 1, true}};
    return scene;
}

TEST(Pose, SkinningFollowsTheJointsAndIgnoresTheNode) {
    const auto posed = poseScene(bendingScene(), {.open = 1, .close = 1, .previousOpen = 0});
    const PosedInstance& instance = posed->instances[0];
    EXPECT_EQ(instance.worldFromObject, Mat4(1)) << "skinned vertices are in world space";
    ASSERT_NE(instance.deformed, nullptr);
    const DeformedVertices& v = *instance.deformed;
    expectNear(v.positions[0], {0, 0, 0});
    expectNear(v.positions[1], {1, 0, 0});
    expectNear(v.positions[2], {1, 1, 0});  // a quarter turn about x = 1
    expectNear(v.normals[2], {-1, 0, 0});
    expectNear(v.tangents[2], {0, 1, 0});
    expectNear(v.normals[1], glm::normalize(Vec3(-0.5f, 0.5f, 0)));
    expectNear(instance.deformedPrevious()->positions[2], {2, 0, 0});
    EXPECT_EQ(instance.deformedClose(), instance.deformed);
    EXPECT_TRUE(posed->anythingMoves);
    expectNear(posed->bounds.upper, {1, 1, 0});
}

/// A part of a large skeleton: the mesh names one joint of five, of which the second and the fourth turn.
TEST(Pose, APartOfASkeletonBendsWithTheJointsThatItNames) {
    const auto partNaming = [](uint32_t joint) {
        const auto scene = bendingScene();
        auto mesh = std::make_shared<Mesh>(*scene->instances[0].mesh);
        mesh->skin = {{0, 1, 2, 3}, {joint, joint, joint}, {1, 1, 1}};
        scene->instances[0].mesh = mesh;
        scene->nodes.push_back(node(0, {0, 1, 0}));
        scene->skins = {{{0, 1, 0, 1, 3}, std::vector<Mat4>(5, Mat4(1))}};
        return poseScene(scene, {.open = 0.5f, .close = 1, .previousOpen = 0.25f});
    };
    for (const uint32_t joint : {0u, 1u, 3u, 4u}) {
        const auto posed = partNaming(joint);
        const PosedInstance& part = posed->instances[0];
        const bool turns = joint == 1 || joint == 3;
        EXPECT_EQ(part.deformed != part.deformedClose(), turns) << joint;
        EXPECT_EQ(part.deformed != part.deformedPrevious(), turns) << joint;
        EXPECT_EQ(part.track() != nullptr, turns) << joint;
        EXPECT_EQ(posed->anythingMoves, turns) << joint;
        EXPECT_EQ(part.track() && part.track()->deformed.size() > 2, turns) << "a turn is no straight way";
    }
}

TEST(Pose, DeformedVerticesAreSharedFromFrameToFrame) {
    const auto scene = bendingScene();
    const auto first = poseScene(scene, {.open = 0, .close = 0, .previousOpen = 0});
    EXPECT_EQ(first->instances[0].deformed, first->instances[0].deformedPrevious());
    const auto second = poseScene(scene, {.open = 0.5f, .close = 0.5f, .previousOpen = 0}, first.get());
    EXPECT_EQ(second->instances[0].deformedPrevious(), first->instances[0].deformed);
    EXPECT_NE(second->instances[0].deformed, first->instances[0].deformed);
    EXPECT_GT(second->byteCount(), 0u);
}

TEST(Pose, MorphTargetsAddUp) {
    Mesh mesh = *bar();
    mesh.morphTargets = {{{{0, 1, 0}, {0, 1, 0}, {0, 1, 0}}, {{1, -1, 0}, {0, 0, 0}, {0, 0, 0}}, {}},
                         {{{0, 0, 4}, {0, 0, 0}, {0, 0, 0}}, {}, {}}};
    const std::vector<float> weights{1, 0.5f};
    const DeformedVertices v = deform(mesh, weights, {});
    expectNear(v.positions[0], {0, 1, 2});
    expectNear(v.positions[2], {2, 1, 0});
    expectNear(v.normals[0], {1, 0, 0});
    expectNear(v.normals[1], {0, 1, 0});
    expectNear(v.tangents[0], {1, 0, 0});
    const std::vector<float> few{1};
    expectNear(deform(mesh, few, {}).positions[0], {0, 1, 0});
}

TEST(Pose, NormalsOfScaledJointsStayPerpendicular) {
    Mesh mesh = *bar();
    mesh.normals.assign(3, glm::normalize(Vec3(1, 1, 0)));
    mesh.tangents.assign(3, Vec4(glm::normalize(Vec3(1, -1, 0)), 1));
    mesh.skin = {{0, 1, 2, 3}, {0, 0, 0}, {1, 1, 1}};
    Mat4 stretched(1);
    stretched[0].x = 4;
    const std::vector<Mat4> joints{stretched};
    const DeformedVertices v = deform(mesh, {}, joints);
    EXPECT_NEAR(glm::dot(v.normals[0], v.tangents[0]), 0, 1e-6f);
    expectNear(v.normals[0], glm::normalize(Vec3(1, 4, 0)));
}

/// The bar with a third vertex off its line, its vertices on joints 0, 1 and 1.
Mesh handed() {
    Mesh mesh = *bar();
    mesh.positions[2] = {0, 0, -1};
    mesh.skin = {{0, 1, 2, 3}, {0, 1, 1}, {1, 1, 1}};
    return mesh;
}

Mat4 scaled(const Vec3& s) { return Transform{Vec3(0), Quat(1, 0, 0, 0), s}.matrix(); }

TEST(Pose, JointsMirrorWhatMostVerticesSay) {
    const Mesh mesh = handed();
    const Mat4 mirror = scaled({-1, 1, 1}), turn = scaled({-1, -1, 1}), still(1);
    const auto isMirrored = [&](const Mat4& first, const Mat4& others) {
        return deform(mesh, {}, std::vector<Mat4>{first, others}).isMirrored();
    };
    EXPECT_TRUE(isMirrored(mirror, mirror));
    EXPECT_TRUE(isMirrored(still, mirror));
    EXPECT_FALSE(isMirrored(mirror, turn));
    EXPECT_FALSE(isMirrored(turn, still));
    EXPECT_FALSE(deform(mesh, {}, {}).isMirrored());
    // Half turns about three axes add up to a mirror, though none of them is one.
    Mesh three = mesh;
    three.skin.joint = {0, 1, 2};
    EXPECT_FALSE(deform(three, {}, std::vector<Mat4>{turn, scaled({-1, 1, -1}), scaled({1, -1, -1})}).isMirrored());
}

TEST(Pose, BitangentsGoWithTheJoints) {
    Mesh mesh = handed();
    const Vec3 tangent = glm::normalize(Vec3(1, 0, 2)), across = glm::cross(Vec3(0, 1, 0), tangent);
    mesh.tangents.assign(3, Vec4(tangent, -1));
    for (const Vec3& scale : {Vec3(-1, 1, 1), Vec3(3, 0.5f, 0.7f), Vec3(-2, -1, -0.4f)}) {
        const DeformedVertices v = deform(mesh, {}, std::vector<Mat4>(2, scaled(scale)));
        ASSERT_EQ(v.bitangents.size(), 3u);
        expectNear(v.bitangents[2], glm::normalize(scale * across));
        expectNear(v.tangents[2], glm::normalize(scale * tangent));
    }
    EXPECT_TRUE(deform(mesh, {}, {}).bitangents.empty()) << "their cross product will do";
}

TEST(Pose, FlatFacesKeepTheirFrontOnJointsThatMirror) {
    Mesh mesh = handed();
    mesh.morphTargets = {{{{0, 0, 0}, {0, 1, 0}, {0, 0, 0}}, std::vector<Vec3>(3, kFaceNormal), {}}};
    const std::vector<float> weights{1};
    // The plane y = x at weight 1, x mirrored: y = -x.
    for (const Vec3& scale : {Vec3(1), Vec3(-1, 1, 1), Vec3(-1, 1, -1), Vec3(1, 1, -1)}) {
        const DeformedVertices v = deform(mesh, weights, std::vector<Mat4>(2, scaled(scale)));
        for (const Vec3& n : v.normals) expectNear(n, glm::normalize(Vec3(-scale.x, 1, 0)));
        expectNear(v.bitangents[0], scale * Vec3(0, 0, -1));
    }
}

/// From scale 1 to `last` while the shutter is open.
TEST(Pose, AShutterKnowsWhenJointsBeginToMirror) {
    for (const Vec3& last : {Vec3(-3, 1, 1), Vec3(-3), Vec3(1, -3, 2)}) {
        auto scene = std::make_shared<Scene>();
        scene->materials.resize(1);
        scene->nodes = {node(-1, {0, 0, 0})};
        Instance instance;
        instance.mesh = std::make_shared<Mesh>(handed());
        instance.skin = 0;
        scene->instances = {instance};
        scene->skins = {{{0, 0}, {Mat4(1), Mat4(1)}}};
        AnimationChannel scale;
        scale.node = 0;
        scale.property = AnimatedProperty::Scale;
        scale.times = {0, 1};
        scale.values = {1, 1, 1, last.x, last.y, last.z};
        scene->animations = {{{scale}, 1, false}};
        const auto posed = poseScene(scene, {.open = 0, .close = 1, .previousOpen = 0});
        const ShutterTrack* track = posed->instances[0].track();
        ASSERT_TRUE(track && track->deformed.size() > 1);
        for (const float time : {0.0f, 0.1f, 0.24f}) EXPECT_FALSE(track->isMirroredAt(time)) << time;
        for (const float time : {0.26f, 0.5f, 0.7f, 1.0f}) EXPECT_TRUE(track->isMirroredAt(time)) << time;
    }
}

TEST(Pose, MorphWeightsAreAnimated) {
    auto scene = slidingScene();
    auto mesh = std::make_shared<Mesh>(*scene->instances[0].mesh);
    mesh->morphTargets = {{{{0, 1, 0}, {0, 1, 0}, {0, 1, 0}}, {}, {}}};
    scene->instances[0].mesh = mesh;
    AnimationChannel weights;
    weights.node = 1;
    weights.property = AnimatedProperty::MorphWeights;
    weights.components = 1;
    weights.times = {0, 1};
    weights.values = {0, 2};
    scene->animations.push_back({{weights}, 1, true});
    const auto posed = poseScene(scene, {.open = 0.5f, .close = 0.5f, .previousOpen = 0.25f});
    expectNear(posed->instances[0].deformed->positions[0], {0, 1, 0});
    expectNear(posed->instances[0].deformedPrevious()->positions[0], {0, 0.5f, 0});
}

/// Three nodes with one mesh that morphs: the first two with equal weights, all moved by one animation.
TEST(Pose, WhatBendsAlikeIsHeldOnce) {
    auto scene = slidingScene();
    auto mesh = std::make_shared<Mesh>(*bar());
    constexpr size_t kVertices = 100000;
    mesh->positions.resize(kVertices);
    mesh->normals.clear();
    mesh->tangents.clear();
    mesh->morphTargets = {{std::vector<Vec3>(kVertices, Vec3(0, 1, 0)), {}, {}}};
    scene->instances.assign(3, scene->instances[0]);
    scene->nodes.resize(4);
    for (int i = 0; i < 3; ++i) {
        AnimationChannel weights;
        weights.node = i + 1;
        weights.property = AnimatedProperty::MorphWeights;
        weights.components = 1;
        weights.times = {0, 1};
        weights.values = {0, i < 2 ? 2.0f : 3.0f};
        scene->animations.push_back({{weights}, 1, true});
        scene->instances[static_cast<size_t>(i)].mesh = mesh;
        scene->instances[static_cast<size_t>(i)].node = i + 1;
    }
    const auto posed = poseScene(scene, {.open = 0.25f, .close = 0.5f, .previousOpen = 0.125f});
    const auto& [first, twin, other] = std::tie(posed->instances[0], posed->instances[1], posed->instances[2]);
    EXPECT_EQ(first.deformed, twin.deformed);
    EXPECT_EQ(first.deformedPrevious(), twin.deformedPrevious());
    EXPECT_NE(first.deformed, other.deformed);
    ASSERT_TRUE(first.track() && twin.track());
    EXPECT_EQ(first.track()->deformed, twin.track()->deformed);
    const size_t shape = kVertices * sizeof(Vec3), moments = first.track()->deformed.size();
    EXPECT_LT(posed->byteCount(), 2 * moments * shape + 100000);
    const test::MemoryLimit limit(shape / 2);
    test::expectError(ErrorKind::Resources, [&] { poseScene(scene, {}); }, {"posing", "memory limit"});
}

TEST(Pose, LightsRideOnTheirNodes) {
    auto scene = slidingScene();
    Light light;
    light.node = 1;
    scene->lights = {light};
    const auto posed = poseScene(scene, {.open = 0.5f, .close = 0.5f, .previousOpen = 0.25f});
    expectNear(Vec3(posed->lights[0].worldFromLight[3]), {5, 1, 0});
    expectNear(Vec3(posed->lights[0].worldFromLightPrevious[3]), {2.5f, 1, 0});
}

TEST(Pose, DoesNotDependOnTheThreadCount) {
    auto scene = bendingScene();
    const auto many = poseScene(scene, {.open = 0.3f, .close = 0.4f, .previousOpen = 0.2f});
    setThreadCount(1);
    const auto one = poseScene(scene, {.open = 0.3f, .close = 0.4f, .previousOpen = 0.2f});
    setThreadCount(0);
    EXPECT_EQ(many->instances[0].deformed->positions, one->instances[0].deformed->positions);
    EXPECT_EQ(many->instances[0].deformedClose()->normals, one->instances[0].deformedClose()->normals);
}

}  // namespace
}  // namespace lumi
