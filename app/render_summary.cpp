#include "app/render_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "base/memory.h"
#include "math/statistics.h"
#include "params/json_text.h"
#include "session/ray_rate.h"

namespace lumi {
using nlohmann::json;

void RenderSummary::add(const FrameOutput& frame) {
    ++frames_;
    const RayRate rate = rayRate(frame);
    rays_ += rate.rays, traceMs_ += rate.ms;
    nonFinite_ += frame.rays.nonFinite;
    for (const auto& [instance, rays] : frame.runRays) nonFinite_ += rays.nonFinite;
    moduleBytes_ = frame.moduleBytes;
    for (const auto& [instance, pixels] : frame.droppedPixels) dropped_[instance] += pixels;
    pixels_ = std::max<int64_t>(frame.camera.extent.area(), 1);
    for (const auto& [stage, ms] : frame.stagesMs) {
        if (!stages_.count(stage)) order_.push_back(stage);
        stages_[stage].push_back(ms);
    }
}

void RenderSummary::print(const std::vector<std::string>& files, const MachineOptions& machine, MessageLog& log,
                          double seconds) const {
    if (nonFinite_ > 0) log.warning(fmt::format("{} path contributions were not finite and were dropped", nonFinite_));
    for (const auto& [instance, pixels] : dropped_)
        if (pixels > 0)
            log.warning(fmt::format("{} dropped {} pixels of its input that were not finite", instance, pixels));
    const double mraysPerSecond = traceMs_ > 0 ? static_cast<double>(rays_) / traceMs_ / 1000 : 0;
    if (machine.json) {
        json stages = json::object();
        for (const std::string& stage : order_) stages[stage] = median(stages_.at(stage));
        const json result = {{"frames", frames_},
                             {"frames_kept", kept_},
                             {"stages_ms", stages},
                             {"rays", rays_},
                             {"mrays_per_s", mraysPerSecond},
                             {"files", files},
                             {"peak_memory_bytes", peakResidentBytes()},
                             {"module_bytes", moduleBytes_},
                             {"dropped_pixels", dropped_},
                             {"warnings", log.warnings()}};
        std::puts(jsonText(result, 2).c_str());
    }
    if (machine.quiet) return;
    const size_t shown = std::min<size_t>(files.size(), 4);
    for (size_t i = 0; i < shown; ++i) std::fputs(("Wrote " + files[i] + "\n").c_str(), stderr);
    if (shown < files.size()) std::fputs(fmt::format("... and {} more files\n", files.size() - shown).c_str(), stderr);
    std::fputs(
        fmt::format("{} frame{}, {:.1f} Mrays at {:.2f} Mray/s, {:.1f} s, {}\n", frames_, frames_ == 1 ? "" : "s",
                    static_cast<double>(rays_) / 1e6, mraysPerSecond, seconds, formatBytes(peakResidentBytes()))
            .c_str(),
        stderr);
    for (const auto& [instance, bytes] : moduleBytes_)
        if (bytes > 0)
            std::fputs(fmt::format("{} holds {}, {:.0f} bytes a pixel\n", instance, formatBytes(bytes),
                                   static_cast<double>(bytes) / static_cast<double>(pixels_))
                           .c_str(),
                       stderr);
}

}  // namespace lumi
