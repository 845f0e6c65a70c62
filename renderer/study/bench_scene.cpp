#include "study/bench_scene.h"

#include <cstdlib>

#include "scene/load.h"
#include "session/document.h"
#include "study/bench_timing.h"

namespace lumi {
namespace fs = std::filesystem;

std::optional<fs::path> benchSceneFile(const std::string& name) {
    if (name != "sponza") return findScene(name);
    const char* folder = std::getenv("LUMISCOPE_ASSETS");
    const fs::path assets = folder ? fs::path(folder) : fs::path(LUMISCOPE_SOURCE_DIR) / ".." / "shared" / "assets";
    const fs::path file = assets / "gltf" / "Sponza" / "Sponza.gltf";
    std::error_code ignored;
    if (!fs::is_regular_file(file, ignored)) return std::nullopt;
    return file;
}

std::shared_ptr<const Scene> loadBenchScene(const fs::path& file, MessageLog& log, std::stop_token stop) {
    LoadOptions options;
    options.stop = std::move(stop);
    return loadScene(file, log, options);
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
