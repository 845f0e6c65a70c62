#pragma once
#include <filesystem>
#include <memory>
#include <optional>

#include "base/messages.h"
#include "study/bench_rays.h"
#include "trace/tracer.h"

namespace lumi {

constexpr Extent2 kBenchExtent{640, 360};

/// The file of a scene that is measured; nothing if this machine does not have it.
std::optional<std::filesystem::path> benchSceneFile(const std::string& name);

std::shared_ptr<const Scene> loadBenchScene(const std::filesystem::path& file, MessageLog& log, std::stop_token stop);

/// A floor with two boxes under a canopy of 100,352 triangles and a strip of ten: the canopy shines if `many`, else the
/// strip, with about the light that the canopy would send.
std::shared_ptr<const Scene> emitterScene(bool many, MessageLog& log, std::stop_token stop);

/// A scene in a tracer, and frames of it at one sample a pixel as its own settings say.
class BenchScene {
public:
    BenchScene(std::shared_ptr<const Scene> scene, Extent2 extent);

    const Scene& scene() const { return *scene_; }
    const Tracer& tracer() const { return tracer_; }
    PathSettings& path() { return sampling_.path; }

    /// Traces frame `number`'s radiance and returns its number of rays. Throws Error(Interrupted) if stopped.
    uint64_t render(uint32_t number, const std::stop_token& stop);
    /// Frame 0 with all its rays.
    RecordedRays record(const std::stop_token& stop);

private:
    std::shared_ptr<const Scene> scene_;
    Tracer tracer_;
    FrameSampling sampling_;
    Signals signals_;
};

}  // namespace lumi
