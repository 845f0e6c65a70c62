#include "filter/edge_avoiding.h"

#include "base/parallel.h"
#include "filter/edge_avoiding_kernels.h"

namespace lumi {

bool edgeAvoidingLevel(const Signals& signals, const EdgeAvoidingSettings& settings, int level, const Image& in,
                       Image& out, std::stop_token stop) {
    constexpr float kLog2E = 1.44269504f;
    const auto scale = [](float sigma) { return kLog2E / (sigma * sigma); };
    const float factor = static_cast<float>(1 << level);
    EdgeAvoidingRow shared;
    shared.width = in.width();
    shared.height = in.height();
    shared.step = 1 << level;
    if (out.extent() != in.extent()) out.reset(in.extent(), 3);
    for (int c = 0; c < 3; ++c) {
        shared.rgb[c] = in.plane(c).data;
        shared.normal[c] = signals[Signal::Normal].plane(c).data;
        shared.position[c] = signals[Signal::Position].plane(c).data;
        shared.out[c] = out.plane(c).data;
    }
    shared.inverseDepth = signals[Signal::InverseDepth].plane(0).data;
    shared.colourScale = scale(settings.sigmaColour / factor);
    shared.normalScale = scale(settings.sigmaNormal * factor);
    shared.positionScale = scale(settings.sigmaPosition);
    parallelRanges(
        in.height(), 8,
        [&](int64_t begin, int64_t end) {
            EdgeAvoidingRow row = shared;
            for (row.y = static_cast<int>(begin); row.y < end; ++row.y) edgeAvoidingKernels().filterRow(row);
        },
        stop);
    return !stop.stop_requested();
}

}  // namespace lumi
