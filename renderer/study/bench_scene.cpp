#include "study/bench_scene.h"

#include "base/error.h"
#include "base/files.h"
#include "scene/asset_folder.h"
#include "scene/load.h"
#include "session/document.h"
#include "study/bench_program.h"
#include "study/bench_timing.h"

namespace lumi {
namespace fs = std::filesystem;

std::optional<fs::path> benchSceneFile(const std::string& name) {
    if (name != "sponza") return findScene(name);
    try {
        return findAsset("assets:gltf/Sponza/Sponza.gltf");
    } catch (const Error&) {
        return std::nullopt;
    }
}

std::shared_ptr<const Scene> loadBenchScene(const fs::path& file, MessageLog& log, std::stop_token stop) {
    LoadOptions options;
    options.stop = std::move(stop);
    return loadScene(file, log, options);
}

std::shared_ptr<const Scene> emitterScene(bool many, MessageLog& log, std::stop_token stop) {
    static constexpr const char* kScene = R"({"version": 1,
        "assets": {"floor": {"rectangle": {"size": [12, 12]}}, "box": {"box": {"size": [1, 1, 1]}},
                   "canopy": {"plane-grid": {"size": [8, 8], "columns": 224, "rows": 224}},
                   "strip": {"plane-grid": {"size": [4, 1], "columns": 5, "rows": 1}}},
        "materials": {"grey": {"base-color": [0.6, 0.6, 0.6]},
                      "glow": {"base-color": [0.5, 0.5, 0.5], "emission": [1, 0.9, 0.8]},
                      "glare": {"base-color": [0.5, 0.5, 0.5], "emission": [16, 14, 12]}},
        "instances": [{"name": "floor", "asset": "floor", "material": "grey"},
                      {"name": "left", "asset": "box", "material": "grey", "translate": [-1.5, 0.5, 0.5]},
                      {"name": "right", "asset": "box", "material": "grey", "translate": [1, 0.5, 0]},
                      {"name": "canopy", "asset": "canopy", "material": "CANOPY", "translate": [0, 4, 0]},
                      {"name": "strip", "asset": "strip", "material": "STRIP", "translate": [0, 3.5, 0]}],
        "environment": {"constant": [0, 0, 0]},
        "cameras": {"main": {"eye": [0, 2, 6], "look-at": [0, 0.8, 0], "fov-y-deg": 55}}})";
    std::string text = kScene;
    text.replace(text.find("CANOPY"), 6, many ? "glow" : "grey");
    text.replace(text.find("STRIP"), 5, many ? "grey" : "glare");
    const ScratchFolder folder;
    const fs::path file = folder.path() / "emitters.json";
    writeFileAtomically(file, text);
    return loadBenchScene(file, log, std::move(stop));
}

BenchScene::BenchScene(std::shared_ptr<const Scene> scene, Extent2 extent) : scene_(std::move(scene)) {
    const Document document(scene_);
    tracer_.bind(poseScene(document.scene(), {}));
    sampling_.extent = extent;
    sampling_.camera = sampling_.previousCamera = poseCamera(document.camera(), extent);
    sampling_.path = document.path();
    sampling_.wanted = {Signal::Noisy};
}

uint64_t BenchScene::render(uint32_t number, const std::stop_token& stop) {
    sampling_.frame = number;
    sampling_.firstSample = number;
    tracer_.resetCounts();
    if (!tracer_.sample(sampling_, signals_, stop)) throwIfStopped(stop);
    return tracer_.counts().total();
}

RecordedRays BenchScene::record(const std::stop_token& stop) {
    RayRecorder recorder;
    tracer_.recordRays(&recorder);
    render(0, stop);
    tracer_.recordRays(nullptr);
    return recorder.take();
}

}  // namespace lumi
