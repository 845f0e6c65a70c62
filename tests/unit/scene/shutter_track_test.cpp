// Tracks of what moves while the shutter is open, against where it truly is; also where it comes back in between.
#include <gtest/gtest.h>

#include "scene/camera_track.h"
#include "scene/posed_scene.h"
#include "scene/shutter_segments.h"

namespace lumi {
namespace {

constexpr float kTurn = 6.28318531f;

/// A card of half a metre on a node with one channel of linear places.
std::shared_ptr<Scene> movingCard(std::vector<float> times, const std::vector<Vec3>& places, bool loop = false) {
    auto scene = std::make_shared<Scene>();
    scene->materials.resize(1);
    scene->nodes.resize(1);
    auto mesh = std::make_shared<Mesh>();
    mesh->positions = {{0, 0, 0}, {0.5f, 0, 0}, {0, 0.5f, 0}};
    mesh->triangles = {{0, 1, 2}};
    Instance instance;
    instance.mesh = mesh;
    instance.node = 0;
    scene->instances = {instance};
    AnimationChannel channel;
    channel.node = 0;
    channel.times = std::move(times);
    for (const Vec3& place : places)
        for (int c = 0; c < 3; ++c) channel.values.push_back(place[c]);
    scene->animations = {{{channel}, channel.times.back(), loop}};
    return scene;
}

/// On a circle in the first second, of `keys` keys.
std::shared_ptr<Scene> circling(int turns, int keys) {
    std::vector<float> times;
    std::vector<Vec3> places;
    for (int i = 0; i <= keys; ++i) {
        const float part = static_cast<float>(i) / static_cast<float>(keys);
        const float angle = kTurn * static_cast<float>(turns) * part;
        times.push_back(part);
        places.emplace_back(std::cos(angle), std::sin(angle), 0);
    }
    return movingCard(times, places);
}

/// How far the track of the only instance is off its place, metres at most, over the time from `open` to `close`.
float farthestOff(const std::shared_ptr<Scene>& scene, float open, float close) {
    const auto posed = poseScene(scene, {.open = open, .close = close, .previousOpen = open});
    const ShutterTrack* track = posed->instances[0].track();
    float farthest = 0;
    for (int i = 0; i <= 1000; ++i) {
        const float part = static_cast<float>(i) / 1000;
        const float time = glm::mix(open, close, part);
        const Mat4 truth =
            poseScene(scene, {.open = time, .close = time, .previousOpen = time})->instances[0].worldFromObject;
        const Mat4 found = track ? track->worldFromObjectAt(part) : posed->instances[0].worldFromObject;
        farthest = std::max(farthest, glm::distance(Vec3(found[3]), Vec3(truth[3])));
    }
    return farthest;
}

TEST(ShutterTrack, FollowsTurnsWhosePlacesComeBackAtEveryHalving) {
    for (const int turns : {1, 2, 3, 4, 8}) EXPECT_LT(farthestOff(circling(turns, 8 * turns), 0, 1), 0.06f) << turns;
}

/// Beside a card that stands still, a light on a node with one channel that loops through a second.
std::shared_ptr<Scene> movingLight(LightType type, AnimationChannel channel) {
    auto scene = movingCard({0, 1}, {Vec3(0), Vec3(0)});
    scene->nodes.resize(2);
    Light light;
    light.type = type;
    light.node = 1;
    scene->lights = {light};
    channel.node = 1;
    scene->animations = {{{channel}, 1, false}};
    return scene;
}

TEST(ShutterTrack, ALightThatAloneMovesKeepsToItsWay) {
    AnimationChannel places;
    places.times = {0, 0.25f, 0.5f, 0.75f, 1};
    for (const float x : {-2, 2, -2, 2, -2}) places.values.insert(places.values.end(), {x, 0, 0});
    for (const LightType type : {LightType::Point, LightType::Spot}) {
        const auto scene = movingLight(type, places);
        const auto posed = poseScene(scene, {.open = 0, .close = 1, .previousOpen = 0});
        for (int i = 0; i <= 100; ++i) {
            const float time = static_cast<float>(i) / 100;
            const float truth = 2 - 8 * std::abs(2 * time - std::floor(2 * time) - 0.5f);
            EXPECT_NEAR(posed->lights[0].worldFromLightAt(time)[3].x, truth, 0.01f) << time;
        }
    }
}

TEST(ShutterTrack, ALightThatAloneTurnsKeepsToItsAxis) {
    AnimationChannel turn;
    turn.property = AnimatedProperty::Rotation;
    turn.components = 4;
    for (int i = 0; i <= 16; ++i) {
        const float angle = kTurn * static_cast<float>(i) / 16;
        turn.times.push_back(static_cast<float>(i) / 16);
        turn.values.insert(turn.values.end(), {0, std::sin(angle / 2), 0, std::cos(angle / 2)});
    }
    for (const LightType type : {LightType::Spot, LightType::Directional}) {
        const auto posed = poseScene(movingLight(type, turn), {.open = 0, .close = 1, .previousOpen = 0});
        for (int i = 0; i <= 100; ++i) {
            const float time = static_cast<float>(i) / 100;
            const Vec3 axis = glm::normalize(Vec3(posed->lights[0].worldFromLightAt(time)[2]));
            EXPECT_LT(glm::distance(axis, Vec3(std::sin(kTurn * time), 0, std::cos(kTurn * time))), 0.01f) << time;
        }
    }
}

TEST(ShutterTrack, SeesAnExcursionBetweenTheHalvings) {
    const std::vector<float> times{0, 0.40f, 0.4375f, 0.475f, 1};
    const std::vector<Vec3> places{Vec3(0), Vec3(0), Vec3(3, 0, 0), Vec3(0), Vec3(0)};
    EXPECT_LT(farthestOff(movingCard(times, places), 0, 1), 0.8f) << "64 segments cut its corners";
    // The same in a later round of a loop.
    EXPECT_LT(farthestOff(movingCard(times, places, true), 3, 4), 0.8f);
    EXPECT_LT(farthestOff(movingCard(times, places, true), 2.3f, 2.5f), 0.2f);
}

TEST(ShutterTrack, AStraightWayTakesTwoSegmentsHoweverManyKeysItHas) {
    std::vector<float> times;
    std::vector<Vec3> places;
    for (int i = 0; i <= 1000; ++i) {
        times.push_back(static_cast<float>(i) / 1000);
        places.emplace_back(times.back(), 0, 0);
    }
    const auto scene = movingCard(times, places);
    const auto posed = poseScene(scene, {.open = 0, .close = 1, .previousOpen = 0});
    ASSERT_NE(posed->instances[0].track(), nullptr);
    EXPECT_EQ(posed->instances[0].track()->worldFromObject.size(), 2u);
    const std::vector<float> turns = shutterTurns(*scene, 0, 1);
    EXPECT_LE(turns.size(), 2 * kMostShutterSegments + 1);
    EXPECT_TRUE(std::is_sorted(turns.begin(), turns.end()));
}

/// The card carried by a joint whose scale goes from 1 to `scale` while it morphs, both evenly.
std::shared_ptr<Scene> bentCard(float scale, bool morphs) {
    auto scene = movingCard({0, 1}, {Vec3(0), Vec3(0)});
    auto mesh = std::make_shared<Mesh>(*scene->instances[0].mesh);
    mesh->skin.first = {0, 1, 2, 3};
    mesh->skin.joint = {0, 0, 0};
    mesh->skin.weight = {1, 1, 1};
    MorphTarget target;
    target.positions = {Vec3(0.4f, 0, 0), Vec3(0), Vec3(0.2f, 0.2f, 0)};
    mesh->morphTargets = {target};
    scene->nodes.resize(2);
    scene->nodes[0].morphWeights = {0};
    scene->instances[0].mesh = mesh;
    scene->instances[0].skin = 0;
    scene->skins.push_back({{1}, {Mat4(1)}});
    AnimationChannel scales, weights;
    scales.node = 1, scales.property = AnimatedProperty::Scale;
    scales.times = weights.times = {0, 1};
    scales.values = {1, 1, 1, scale, 1, 1};
    weights.node = 0, weights.property = AnimatedProperty::MorphWeights, weights.components = 1;
    weights.values = {0, morphs ? 1.0f : 0.0f};
    scene->animations = {{{scales, weights}, 1, false}};
    return scene;
}

// Vertices go along parabolas then, though the joint and the weight go straight.
TEST(ShutterTrack, FollowsWhatMorphsWhileJointsCarryIt) {
    for (const bool morphs : {false, true})
        for (const float scale : {-1.0f, 0.2f, 2.0f}) {
            const auto scene = bentCard(scale, morphs);
            const auto posed = poseScene(scene, {.open = 0, .close = 1, .previousOpen = 0});
            const ShutterTrack& track = *posed->instances[0].track();
            for (int i = 0; i <= 100; ++i) {
                const float time = static_cast<float>(i) / 100;
                const auto truth =
                    poseScene(scene, {.open = time, .close = time, .previousOpen = time})->instances[0].deformed;
                const TrackPlace at = trackPlace(track.deformed.size(), time);
                const auto &from = *track.deformed[at.first], &to = *track.deformed[at.first + (at.fraction > 0)];
                for (size_t v = 0; v < 3; ++v) {
                    const Vec3 found = glm::mix(from.positions[v], to.positions[v], at.fraction);
                    ASSERT_LT(glm::distance(found, truth->positions[v]), 1e-3f) << scale << " at " << time;
                }
            }
            EXPECT_LE(track.deformed.size(), morphs ? 33u : 3u);
        }
}

TEST(ShutterTrack, TurnsAreTheKeysInsideTheOpenShutter) {
    const auto scene = movingCard({0, 0.25f, 1}, std::vector<Vec3>(3, Vec3(0)), true);
    EXPECT_TRUE(shutterTurns(*scene, 0.3f, 0.9f).empty());
    const auto keysOf = [&](float open, float close) {
        std::vector<float> keys = shutterTurns(*scene, open, close);
        for (size_t i = 0; i < keys.size(); ++i) keys.erase(keys.begin() + static_cast<ptrdiff_t>(i));
        return keys;  // every second one
    };
    const auto expectKeys = [&](float open, float close, const std::vector<float>& times) {
        const std::vector<float> found = keysOf(open, close);
        ASSERT_EQ(found.size(), times.size());
        for (size_t i = 0; i < times.size(); ++i) EXPECT_NEAR(glm::mix(open, close, found[i]), times[i], 1e-5f);
    };
    expectKeys(0.1f, 0.5f, {0.25f});
    expectKeys(5.1f, 5.5f, {5.25f});
    expectKeys(0.9f, 2.5f, {1, 1.25f, 2, 2.25f});
    expectKeys(-0.8f, -0.5f, {-0.75f});
    EXPECT_TRUE(shutterTurns(*scene, 0, 1e6f).empty()) << "faster than can be followed";
}

/// Over a second, by keys.
CameraTrack keyedTrack(const std::vector<SceneCamera::Key>& keys) {
    Scene scene;
    scene.cameras.resize(1);
    scene.cameras[0].keys = keys;
    scene.cameras[0].interpolation = Interpolation::Linear;
    return cameraTrack([&](float part) { return cameraAt(scene, 0, part); },
                       shutterTurns(scene, scene.cameras[0], 0, 1), {320, 180});
}

Vec3 eyeAt(const CameraTrack& track, float time) {
    const TrackPlace place = trackPlace(track.size(), time);
    return interpolate(track[place.first], track[place.first + 1], place.fraction).position();
}

TEST(ShutterTrack, ACameraTakesAsManyPosesAsItsWayIsBent) {
    const auto key = [](float time, const Vec3& eye) {
        return SceneCamera::Key{.time = time, .eye = eye, .target = eye - Vec3(0, 0, 5)};
    };
    EXPECT_TRUE(keyedTrack({key(0, Vec3(1)), key(1, Vec3(1))}).empty());
    EXPECT_EQ(keyedTrack({key(0, Vec3(1)), key(1, Vec3(4))}).size(), 3u);
    const CameraTrack aside = keyedTrack(
        {key(0, Vec3(0)), key(0.40f, Vec3(0)), key(0.4375f, Vec3(3, 0, 0)), key(0.475f, Vec3(0)), key(1, Vec3(0))});
    ASSERT_EQ(aside.size(), kMostShutterSegments + 1);
    EXPECT_GT(eyeAt(aside, 0.4375f).x, 2.9f);
    EXPECT_LT(eyeAt(aside, 0.39f).x, 1e-3f);
}

TEST(ShutterTrack, ACameraOnACircleKeepsToIt) {
    const auto at = [](float part) {
        Camera camera;
        camera.eye = Vec3(5 * std::cos(kTurn * part), 0, 5 * std::sin(kTurn * part));
        return camera;
    };
    const CameraTrack track = cameraTrack(at, {}, {320, 180});
    ASSERT_FALSE(track.empty());
    for (int i = 0; i <= 300; ++i) EXPECT_NEAR(glm::length(eyeAt(track, static_cast<float>(i) / 300)), 5, 0.01f) << i;
}

TEST(ShutterTrack, AFocusThatIsPulledBentTakesMorePoses) {
    const auto posesWith = [](float aperture) {
        const auto at = [&](float part) {
            Camera camera;
            camera.eye.x = part;
            camera.target.x = part;
            camera.aperture = aperture;
            camera.focus = 1 / (0.1f + part);
            return camera;
        };
        return cameraTrack(at, {}, {320, 180}).size();
    };
    EXPECT_EQ(posesWith(0), 3u);
    EXPECT_GT(posesWith(0.1f), 9u);
}

}  // namespace
}  // namespace lumi
