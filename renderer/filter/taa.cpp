#include "filter/taa.h"

#include <cmath>

#include "base/parallel.h"
#include "filter/taa_kernels.h"

namespace lumi {
namespace {

constexpr int64_t kRows = 8;
constexpr int64_t kGrain = 1 << 14;

TaaRow rowOf(const TaaMotion& motion, const TaaSettings& settings, const Image& compressed, const Image* previous) {
    TaaRow row;
    row.width = compressed.width();
    row.height = compressed.height();
    for (int c = 0; c < 3; ++c) {
        row.compressed[c] = compressed.plane(c).data;
        row.previous[c] = previous ? previous->plane(c).data : nullptr;
    }
    for (int c = 0; c < 2; ++c) row.motion[c] = motion.motion.plane(c).data;
    row.nearness = motion.nearness.data();
    row.alpha = settings.alpha;
    row.gamma = settings.gamma;
    row.clip = settings.clip;
    row.catmullRom = settings.history == TaaSettings::History::CatmullRom;
    return row;
}

}  // namespace

void TaaSettings::describe(ParameterVisitor& v) {
    v.number(
        "alpha", alpha,
        {.label = "Alpha", .min = 0.01, .max = 1, .scale = Scale::Log, .help = "Weight of the new frame [Karis14]"});
    v.choice("history-filter", history,
             {.label = "History filter",
              .options = {"bilinear", "catmull-rom"},
              .help = "How the history is read between pixels; Catmull-Rom keeps it sharp under motion"});
    v.toggle("clip", clip,
             {.label = "Clip history", .help = "Clip the history to the colours of the 3x3 neighbourhood"});
    v.when(clip, [&] {
        v.number("clip-gamma", gamma,
                 {.label = "Clip width",
                  .min = 0.25,
                  .max = 4,
                  .scale = Scale::Log,
                  .help = "Half the width of the clipping box in standard deviations of the neighbourhood [Salvi16]"});
    });
}

float exposureFactor(const PosedScene& scene) { return std::exp2(scene.scene->render.exposureEv); }

bool antialiasTemporally(const TaaMotion& motion, const TaaSettings& settings, float exposure, const Image& colour,
                         const Image* previous, Image& scratch, Image& next, Image& out, std::stop_token stop) {
    const Extent2 extent = colour.extent();
    if (previous && previous->extent() != extent) previous = nullptr;
    for (Image* image : {&scratch, &next, &out})
        if (image->extent() != extent) image->reset(extent, 3);
    parallelRanges(extent.area(), kGrain, [&](int64_t begin, int64_t end) {
        const float* in[3];
        float* to[3];
        for (int c = 0; c < 3; ++c) {
            in[c] = colour.plane(c).data + begin;
            to[c] = scratch.plane(c).data + begin;
        }
        taaKernels().compressRow(in, to, exposure, static_cast<int>(end - begin));
    });
    TaaRow shared = rowOf(motion, settings, scratch, previous);
    shared.exposure = exposure;
    parallelRanges(
        extent.height, kRows,
        [&](int64_t begin, int64_t end) {
            TaaRow row = shared;
            for (row.y = static_cast<int>(begin); row.y < end; ++row.y) {
                for (int c = 0; c < 3; ++c) {
                    row.next[c] = next.plane(c).row(row.y);
                    row.out[c] = out.plane(c).row(row.y);
                }
                taaKernels().resolveRow(row);
            }
        },
        stop);
    return !stop.stop_requested();
}

}  // namespace lumi
