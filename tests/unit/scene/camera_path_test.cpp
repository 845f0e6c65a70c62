// Camera paths: our own JSON and instant-ngp's, in and out.
#include <gtest/gtest.h>

#include "base/files.h"
#include "scene/camera_path.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace lumi {
namespace {

CameraPath somePath() {
    CameraPath path;
    path.aperture = 0.02f;
    path.keys = {{0, {0, 1, 5}, {0, 1, 0}, 45, 5},
                 {0.5f, {1, 2, 4}, {0.5f, 0, -1}, 40, 3.5f},
                 {2, {-3, 0.5f, 2}, {0, 0, 0}, 60, 2}};
    return path;
}

void expectNear(const Vec3& a, const Vec3& b) { EXPECT_LT(glm::length(a - b), 1e-4f); }

TEST(CameraPath, BothFormatsComeBack) {
    const test::TemporaryFolder folder;
    for (const auto format : {CameraPathFormat::Lumiscope, CameraPathFormat::InstantNgp}) {
        const CameraPath path = somePath();
        writeFileAtomically(folder / "a.json", formatCameraPath(path, format));
        const CameraPath back = readCameraPath(folder / "a.json");
        ASSERT_EQ(back.keys.size(), 3u);
        EXPECT_EQ(back.interpolation, Interpolation::CatmullRom);
        EXPECT_FLOAT_EQ(back.aperture, 0.02f);
        for (size_t i = 0; i < 3; ++i) {
            EXPECT_EQ(back.keys[i].time, path.keys[i].time);
            expectNear(back.keys[i].eye, path.keys[i].eye);
            expectNear(back.keys[i].target, path.keys[i].target);
            EXPECT_FLOAT_EQ(back.keys[i].fovYDeg, path.keys[i].fovYDeg);
            EXPECT_NEAR(back.keys[i].focus, path.keys[i].focus, 1e-4);
        }
        EXPECT_EQ(formatCameraPath(back, format).size() > 0, true);
    }
    EXPECT_EQ(cameraPathFormatOf("a.ngp.json"), CameraPathFormat::InstantNgp);
    EXPECT_EQ(cameraPathFormatOf("ngp.json"), CameraPathFormat::Lumiscope);
}

TEST(CameraPath, InstantNgpLooksAlongTheThirdColumn) {
    const test::TemporaryFolder folder;
    // Its default camera: right +X, down -Y, forward -Z is half a turn about X. Keys without times share the duration.
    writeFileAtomically(folder / "a.json",
                        std::string_view(R"({"loop":false,"time":0.5,"duration_seconds":6,"spline_order":3,
        "path":[{"R":[1,0,0,0],"T":[0.5,0.25,2],"slice":0.5,"scale":1.5,"fov":50.625,"aperture_size":0.0},
                {"R":[1,0,0,0],"T":[0.5,0.25,1],"slice":0,"scale":1.5,"fov":50.625,"aperture_size":0.1},
                {"R":[0.70710678,0,0.70710678,0],"T":[0,0,0],"slice":0,"scale":2,"fov":30,"aperture_size":0.1}]})"));
    const CameraPath path = readCameraPath(folder / "a.json");
    ASSERT_EQ(path.keys.size(), 3u);
    expectNear(path.keys[0].target, {0.5f, 0.25f, 0.5f});
    EXPECT_FLOAT_EQ(path.keys[0].focus, 2);
    EXPECT_FLOAT_EQ(path.keys[0].fovYDeg, 50.625f);
    EXPECT_FLOAT_EQ(path.aperture, 0.1f);
    EXPECT_EQ(path.keys[1].time, 3);
    EXPECT_EQ(path.keys[2].time, 6);
    expectNear(path.keys[2].target, {2, 0, 0});  // x = 2 (x z + w y) of the quaternion's third column
}

TEST(CameraPath, IsWalkedAsASceneFileWouldBe) {
    CameraPath path = somePath();
    path.interpolation = Interpolation::Linear;
    expectNear(path.at(0.25f).eye, {0.5f, 1.5f, 4.5f});
    EXPECT_FLOAT_EQ(path.at(0.25f).fovYDeg, 42.5f);
    expectNear(path.at(9).eye, path.keys[2].eye);
    EXPECT_EQ(path.duration(), 2);
}

TEST(CameraPath, OfACameraThatStandsOrMoves) {
    Scene scene;
    scene.cameras.emplace_back();
    scene.cameras[0].camera.eye = {0, 1, 7};
    EXPECT_EQ(cameraPathOf(scene, 0, 30).keys.size(), 1u);
    expectNear(cameraPathOf(scene, 0, 30).at(3).eye, {0, 1, 7});
    scene.cameras[0].keys = somePath().keys;
    EXPECT_EQ(cameraPathOf(scene, 0, 30).keys.size(), 3u);
    // Of a camera at a node that is animated: every frame of it, if there are not absurdly many.
    scene.nodes.emplace_back();
    scene.cameras[0].node = 0;
    scene.animations.emplace_back();
    scene.animations[0].duration = 2;
    EXPECT_EQ(cameraPathOf(scene, 0, 30).keys.size(), 61u);
    scene.animations[0].duration = 1e30f;
    test::expectError(ErrorKind::BadInput, [&] { cameraPathOf(scene, 0, 30); }, {"too long", "fewer than 1000000"});
}

TEST(CameraPath, BrokenFilesAreNamedWithTheirKey) {
    const test::TemporaryFolder folder;
    const struct {
        const char *text, *part;
    } cases[] = {
        {"[]", "no camera path"},
        {"{", "no camera path"},
        {R"({"path": 3})", "no camera path"},
        {R"({"path": []})", "no keys"},
        {R"({"path": [{"R": [0,0,0,0], "T": [0,0,0]}]})", "rotation"},
        {R"({"path": [{"R": [1,0,0], "T": [0,0,0]}]})", "\"R\""},
        {R"({"path": [{"R": [1,0,0,0], "T": [0,0,"x"]}]})", "path 0"},
        {R"({"format": "lumiscope-camera-path", "version": 2, "keys": []})", "version"},
        {R"({"format": "lumiscope-camera-path", "version": 1, "keys": []})", "no keys"},
        {R"({"format": "lumiscope-camera-path", "version": 1, "keys": 1})", "list"},
        {R"({"format": "lumiscope-camera-path", "version": 1, "kees": []})", "\"keys\""},
        {R"({"format": "lumiscope-camera-path", "version": 1, "interpolation": "wild", "keys": []})", "catmull-rom"},
        {R"({"format": "lumiscope-camera-path", "version": 1, "keys": [{"time": 0, "eye": [0,0,1], "look-at": [0,0,1]}]})",
         "key 0"},
        {R"({"format": "lumiscope-camera-path", "version": 1, "keys": [{"time": 1, "eye": [0,0,1], "look-at": [0,0,0]},
                                                                      {"time": 1, "eye": [0,0,1], "look-at": [0,0,0]}]})",
         "ascend"},
        {R"({"format": "lumiscope-camera-path", "version": 1, "keys": [{"time": 0, "eye": [0,0,1], "look-at": [0,0,0], "fov-y-deg": 900}]})",
         "170"}};
    for (const auto& broken : cases) {
        writeFileAtomically(folder / "p.json", std::string_view(broken.text));
        test::expectError(ErrorKind::BadInput, [&] { readCameraPath(folder / "p.json"); }, {"p.json", broken.part});
    }
    test::expectError(ErrorKind::BadInput, [&] { readCameraPath(folder / "none.json"); }, {"none.json"});
}

}  // namespace
}  // namespace lumi
