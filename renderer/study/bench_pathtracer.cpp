#include "study/bench_pathtracer.h"

#include <fmt/format.h>

#include "base/parallel.h"
#include "study/bench_program.h"
#include "study/bench_scene.h"
#include "study/obj_export.h"

namespace lumi {
namespace fs = std::filesystem;
namespace {

constexpr const char* kProgram = "/usr/bin/pathtracer";
constexpr const char* kCornell = "/usr/share/doc/embree3/models/cornell_box.obj";
constexpr int kPathLength = 3;  ///< surfaces that scatter; each is one closest-hit and one shadow ray
constexpr int kRounds = 5, kFramesARound = 8, kWarmUp = 2;

struct View {
    Camera camera;
    Vec3 light{0}, intensity{1};
    Extent2 extent;
};

/// The file as `pathtracer` sees it: lit by the one light, seen by the one camera.
std::shared_ptr<const Scene> sceneOf(const fs::path& file, const View& view, std::stop_token stop) {
    MessageLog unread;  // that it has no light of its own, which it gets below
    Scene scene = *loadBenchScene(file, unread, std::move(stop));
    scene.environment = {};
    scene.cameras.assign(1, {});
    scene.cameras[0].camera = view.camera;
    Node node;
    node.name = "lamp";
    node.local.translation = view.light;
    Light lamp;
    lamp.name = "lamp";
    lamp.intensity = view.intensity;
    lamp.node = static_cast<int>(scene.nodes.size());
    scene.nodes.push_back(node);
    scene.lights.assign(1, lamp);
    return std::make_shared<const Scene>(std::move(scene));
}

std::vector<std::string> commandOf(const fs::path& file, const View& view) {
    const auto number = [](auto value) { return fmt::format("{}", value); };
    std::vector<std::string> command{kProgram, "-i", file.string()};
    const auto vector = [&](const char* option, const Vec3& v) {
        command.insert(command.end(), {option, number(v.x), number(v.y), number(v.z)});
    };
    vector("--vp", view.camera.eye);
    vector("--vi", view.camera.target);
    vector("--vu", view.camera.up);
    command.insert(command.end(), {"--righthanded", "--fov", number(view.camera.fovYDeg)});
    vector("--pointlight", view.light);
    command.insert(command.end(), {number(view.intensity.x), number(view.intensity.y), number(view.intensity.z)});
    command.insert(command.end(), {"--size", number(view.extent.width), number(view.extent.height), "--spp", "1",
                                   "--max-path-length", number(kPathLength), "--threads", number(threadCount()),
                                   "--benchmark", number(kWarmUp), number(kFramesARound)});
    return command;
}

/// The number after `key` in what the program prints; 0 if it is not there.
double reported(const std::string& output, const std::string& key) {
    const size_t at = output.find(key);
    return at == std::string::npos ? 0 : std::strtod(output.c_str() + at + key.size(), nullptr);
}

std::optional<PathtracerComparison> compare(const fs::path& file, const View& view, const std::stop_token& stop) {
    BenchScene scene(sceneOf(file, view, stop), view.extent);
    scene.path() = {};
    scene.path().maxDepth = scene.path().maxDiffuseDepth = scene.path().maxSpecularDepth = kPathLength;
    scene.path().roulette = false;
    PathtracerComparison result;
    RunTimes theirs;
    uint32_t frame = 0;
    for (; frame < kWarmUp; ++frame) scene.render(frame, stop);
    uint64_t rays = 0;
    for (int round = 0; round < kRounds; ++round) {
        throwIfStopped(stop);
        const std::string output = outputOf(commandOf(file, view));
        const double mrays = reported(output, "BENCHMARK_RENDER_MRAYPS_AVG ");
        const double frames = reported(output, "BENCHMARK_RENDER_AVG ");
        if (!(mrays > 0) || !(frames > 0)) return std::nullopt;
        theirs.add(1 / mrays);
        result.theirRaysAPath = mrays * 1e6 / frames / static_cast<double>(view.extent.area());
        for (int i = 0; i < kFramesARound; ++i, ++frame)
            result.times.add(timeOf([&] { rays += scene.render(frame, stop); }));
    }
    const double raysAFrame = static_cast<double>(rays) / static_cast<double>(result.times.count());
    result.ownRaysAPath = raysAFrame / static_cast<double>(view.extent.area());
    result.ownMrays = raysAFrame / result.times.median() / 1000;
    result.theirMrays = 1 / theirs.median();
    return result;
}

}  // namespace

bool hasPathtracer() {
    std::error_code ignored;
    return fs::exists(kProgram, ignored) && fs::exists(kCornell, ignored);
}

std::optional<PathtracerComparison> comparePathtracerOnCornell(std::stop_token stop) {
    // The view and light of the model's own .ecs file.
    View view;
    view.camera.eye = {278, 273, -800}, view.camera.target = {278, 273, 0}, view.camera.fovYDeg = 37;
    view.light = {213, 300, 227}, view.intensity = Vec3(100000);
    view.extent = {512, 512};
    return compare(kCornell, view, stop);
}

std::optional<PathtracerComparison> comparePathtracer(const Scene& scene, std::stop_token stop) {
    const ScratchFolder folder;
    const fs::path file = folder.path() / "scene.obj";
    exportObj(scene, file);
    View view;
    const Bounds3 bounds = scene.restBounds();
    view.camera = cameraAt(scene, 0, 0);
    view.light = bounds.centre();
    view.intensity = Vec3(sqr(bounds.radius()));
    view.extent = kBenchExtent;
    return compare(file, view, stop);
}

}  // namespace lumi
