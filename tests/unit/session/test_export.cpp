#include "session/export.h"

#include <nlohmann/json.hpp>

#include "image/png.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"
#include "support/tiny_scene.h"

namespace lumi::test {
namespace {

FrameOutput drawAll(const Document& document) {
    MessageLog log;
    FrameEngine engine(log);
    const BufferSelection all = BufferSelection::all("accumulate");
    engine.advance({document, 0, false, all.signals, {{"accumulate", all.taps}}});
    return *engine.advance({document, 1, false, all.signals, {{"accumulate", all.taps}}});
}

TEST(Export, AnExrHoldsEveryLayerByItsContractName) {
    TemporaryFolder folder;
    const Document document(tinyScene());
    const FrameOutput frame = drawAll(document);
    exportView(folder / "all.exr", frame, document, {0, "all", false}, "{\"state\":1}");
    const ExrLayers layers = readExr(folder / "all.exr");
    for (const char* name : {"R",
                             "G",
                             "B",
                             "A",
                             "Z",
                             "noisy.R",
                             "albedo.G",
                             "specularAlbedo.B",
                             "normal.X",
                             "normal.Y",
                             "normal.Z",
                             "depth.Z",
                             "position.X",
                             "motion.X",
                             "motion.Z",
                             "directDiffuse.R",
                             "indirectSpecular.B",
                             "sampleVariance.R",
                             "visibility.Y",
                             "roughness.Y",
                             "objectId",
                             "materialId",
                             "accumulate-sampleCount.Y",
                             "accumulate-standardError.R"})
        EXPECT_TRUE(layers.channels.count(name)) << name;
    EXPECT_EQ(layers.strings.at(kStateKey), "{\"state\":1}");
    ASSERT_TRUE(layers.worldToCamera && layers.worldToNdc);
    EXPECT_EQ(layers.image("", "RGB"), *frame.results.at("accumulate"));
    EXPECT_EQ(layers.image("albedo", "RGB"), (*frame.signals)[Signal::Albedo]);
    EXPECT_EQ(layers.find("objectId")->type, ExrType::Uint);
    EXPECT_EQ(layers.find("albedo.R")->type, ExrType::Float);
    EXPECT_EQ(layers.find("accumulate-sampleCount.Y")->floats[0], 2);
}

TEST(Export, HalfIsForColoursOnly) {
    TemporaryFolder folder;
    const Document document(tinyScene());
    exportView(folder / "half.exr", drawAll(document), document, {0, "albedo,depth,normal", true}, "{}");
    const ExrLayers layers = readExr(folder / "half.exr");
    EXPECT_EQ(layers.find("R")->type, ExrType::Half);
    EXPECT_EQ(layers.find("albedo.R")->type, ExrType::Half);
    EXPECT_EQ(layers.find("normal.X")->type, ExrType::Float);
    EXPECT_EQ(layers.find("depth.Z")->type, ExrType::Float);
    EXPECT_FALSE(layers.channels.count("position.X"));
}

TEST(Export, TellsWhatHalfDoesNotHold) {
    TemporaryFolder folder;
    const Document document(tinyScene());
    FrameOutput frame = drawAll(document);
    auto bright = std::make_shared<Image>(*frame.results.at("accumulate"));
    bright->at(0, 3, 2) = 1e6f, bright->at(1, 4, 2) = -1e6f, bright->at(2, 5, 2) = kInfinity;
    frame.results["accumulate"] = bright;
    MessageLog log;
    exportView(folder / "half.exr", frame, document, {0, "", true}, "{}").warn(log);
    ASSERT_EQ(log.warnings().size(), 1u);
    EXPECT_NE(log.warnings()[0].find("half.exr: 2 values were beyond"), std::string::npos) << log.warnings()[0];
    EXPECT_EQ(readExr(folder / "half.exr").image("", "RGB").at(0, 3, 2), kMostHalf);
    const Written again = exportNewView(folder / "half.exr", frame, document, {0, "", true}, "{}");
    EXPECT_EQ(again.path, folder / "half-1.exr");
    EXPECT_EQ(again.clamped, 2u);
    exportView(folder / "float.exr", frame, document, {0, "", false}, "{}").warn(log);
    exportView(folder / "picture.png", frame, document, {0, "", true}, "{}").warn(log);
    EXPECT_EQ(log.warnings().size(), 1u);
}

TEST(Export, APngShowsTheViewAndHoldsTheState) {
    TemporaryFolder folder;
    Document document(tinyScene());
    const FrameOutput frame = drawAll(document);
    exportView(folder / "image.png", frame, document, {0, "", false}, "{\"a\":2}");
    document.setText("view.0.buffer", "normal");
    exportView(folder / "normal.png", frame, document, {0, "", false}, "{}");
    const Png image = readPng(folder / "image.png"), normal = readPng(folder / "normal.png");
    EXPECT_EQ(image.extent, (Extent2{16, 12}));
    EXPECT_EQ(image.texts.at(kStateKey), "{\"a\":2}");
    EXPECT_NE(image.rgba, normal.rgba);
    // The floor's normal is +Y: green is 1, red and blue one half.
    const size_t bottom = 4 * (16 * 11 + 8);
    EXPECT_NEAR(normal.rgba[bottom] / 257, 128, 2);
    EXPECT_NEAR(normal.rgba[bottom + 1] / 257, 255, 2);
}

TEST(Export, OtherKindsOfFilesAreRefused) {
    const Document document(tinyScene());
    expectError(ErrorKind::Usage, [&] { exportView("a.jpg", drawAll(document), document, {}, "{}"); },
                {"a.jpg", ".exr"});
}

TEST(BufferSelection, ReadsNamesAndNamesTheNearest) {
    const BufferSelection some =
        BufferSelection::parse("albedo,accumulate-sampleCount,standardError", "accumulate", "--buffers");
    EXPECT_EQ(some.signals, SignalSet{Signal::Albedo});
    EXPECT_EQ(some.taps, (TapSet{"sampleCount", "standardError"}));
    EXPECT_EQ(BufferSelection::parse("all", "none", "").signals, SignalSet::all());
    EXPECT_TRUE(BufferSelection::parse("", "none", "").signals.empty());
    expectError(ErrorKind::Usage, [] { BufferSelection::parse("albdo", "none", "--buffers"); },
                {"--buffers", "\"albedo\""});
}

TEST(OutputChoice, SurvivesJson) {
    const OutputChoice choice = OutputChoice::parse(OutputChoice{1, "albedo", true}.json(), "");
    EXPECT_EQ(choice.view, 1);
    EXPECT_EQ(choice.buffers, "albedo");
    EXPECT_TRUE(choice.half);
    expectError(ErrorKind::BadInput, [] { OutputChoice::parse({{"view", 7}}, "x.exr"); }, {"x.exr"});
    expectError(ErrorKind::BadInput, [] { OutputChoice::parse({{"view", "one"}}, "x.exr"); }, {"x.exr"});
}

TEST(NdcFromCamera, PutsProjectedPointsWhereTheCameraDoes) {
    for (const Projection projection : {Projection::Perspective, Projection::Orthographic}) {
        Camera camera;
        camera.eye = {1, 2, 6};
        camera.projection = projection;
        camera.yMag = 2;
        const CameraPose pose = poseCamera(camera, {64, 48});
        const Vec3 point(0.3f, 0.4f, -0.2f);
        const Vec4 clip = ndcFromCamera(pose) * (pose.cameraFromWorld * Vec4(point, 1));
        const Vec3 pixel = pose.project(point);
        EXPECT_NEAR((clip.x / clip.w * 0.5f + 0.5f) * 64, pixel.x, 1e-3f);
        EXPECT_NEAR((0.5f - clip.y / clip.w * 0.5f) * 48, pixel.y, 1e-3f);
    }
}

}  // namespace
}  // namespace lumi::test
