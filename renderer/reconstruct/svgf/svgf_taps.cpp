#include "reconstruct/svgf/svgf_taps.h"

#include "base/parallel.h"
#include "filter/edge_weights.h"
#include "reconstruct/screen_filter.h"

namespace lumi {
namespace {

constexpr const char* kRadiance = "W/(m^2 sr)";

}  // namespace

std::vector<Tap> svgfTaps(int maxLevels) {
    std::vector<Tap> taps = temporalTaps();
    const Tap fixed[] = {
        {.name = "demodulatedDirect",
         .channels = "RGB",
         .colourMap = "none",
         .help = "Direct illumination of this frame, divided by the albedo"},
        {.name = "demodulatedIndirect",
         .channels = "RGB",
         .colourMap = "none",
         .help = "Indirect illumination of this frame, divided by the albedo"},
        {.name = "demodulationAlbedo",
         .channels = "RGB",
         .colourMap = "none",
         .help = "What illumination is divided by: the lobes' albedos together"},
        {.name = "depthWeight",
         .channels = "Y",
         .range = ValueRange{0, 1},
         .colourMap = "gray",
         .help = "w_z (eq. 3), mean of the eight neighbours at the first level"},
        {.name = "normalWeight",
         .channels = "Y",
         .range = ValueRange{0, 1},
         .colourMap = "gray",
         .help = "w_n (eq. 4), mean of the eight neighbours at the first level"},
    };
    taps.insert(taps.end(), std::begin(fixed), std::end(fixed));
    for (const char* component : {"direct", "indirect"}) {
        const std::string name = component;
        taps.push_back({.name = name + "LuminanceWeight",
                        .channels = "Y",
                        .range = ValueRange{0, 1},
                        .colourMap = "gray",
                        .help = "w_l (eq. 5), mean of the eight neighbours at the first level"});
        taps.push_back({.name = name + "FirstMoment",
                        .channels = "Y",
                        .unit = kRadiance,
                        .help = "mu1', the integrated luminance (sec. 4.2)"});
        taps.push_back({.name = name + "SecondMoment",
                        .channels = "Y",
                        .help = "mu2', the integrated square of the luminance (sec. 4.2)"});
        for (int level = 0; level <= maxLevels; ++level) {
            const std::string number = std::to_string(level);
            taps.push_back({.name = name + "Level" + number,
                            .channels = "RGB",
                            .unit = kRadiance,
                            .colourMap = "none",
                            .help = level == 0 ? "Integrated illumination, the first level's input"
                                               : "Illumination after this level; the last one's where fewer run"});
            taps.push_back({.name = name + "Variance" + number,
                            .channels = "Y",
                            .colourMap = "magma",
                            .help = level == 0
                                        ? "Estimated variance of a sample's luminance, the first level's input"
                                        : "Variance of luminance after this level; the last one's where fewer run"});
        }
    }
    return taps;
}

void keepInput(CapturedTaps& taps, const DemodulatedFrame& frame) {
    taps.keep("demodulatedDirect", frame.direct);
    taps.keep("demodulatedIndirect", frame.indirect);
    taps.keep("demodulationAlbedo", frame.albedo);
}

void keepIntegrated(CapturedTaps& taps, const TemporalHistory& integrated) {
    taps.keep("historyLength", integrated.length);
    for (size_t c = 0; c < integrated.components.size(); ++c) {
        const TemporalComponent& component = integrated.components[c];
        const std::string name = c == 0 ? "direct" : "indirect";
        taps.keep(name + "FirstMoment", component.mean);
        if (Image* second = taps.target(name + "SecondMoment")) {
            *second = component.sampleVariance;
            for (size_t i = 0; i < second->size(); ++i)
                second->data()[i] += component.mean.data()[i] * component.mean.data()[i];
        }
    }
}

void keepLevel(CapturedTaps& taps, int level, bool indirect, const Illumination& planes) {
    const std::string name = indirect ? "indirect" : "direct", number = std::to_string(level);
    taps.keep(name + "Level" + number, planes.rgb);
    taps.keep(name + "Variance" + number, planes.sampleVariance);
}

void keepEdgeWeights(CapturedTaps& taps, const SurfaceGuide& guide, const AtrousSettings& settings,
                     const Illumination& direct, const Illumination& indirect) {
    Image* const targets[4] = {taps.target("depthWeight"), taps.target("normalWeight"),
                               taps.target("directLuminanceWeight"), taps.target("indirectLuminanceWeight")};
    if (!targets[0] && !targets[1] && !targets[2] && !targets[3]) return;
    for (Image* image : targets)
        if (image) image->reset({guide.width, guide.height}, 1);
    parallelFor(guide.height, [&](int64_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < guide.width; ++x) {
            float sums[4] = {0, 0, 0, 0};
            int count = 0;
            for (int j = -1; j <= 1; ++j)
                for (int i = -1; i <= 1; ++i) {
                    if ((i == 0 && j == 0) || x + i < 0 || y + j < 0 || x + i >= guide.width || y + j >= guide.height)
                        continue;
                    const EdgeWeights w = edgeWeights(guide, settings, direct, {x, y}, i, j);
                    sums[0] += w.depth;
                    sums[1] += w.normal;
                    sums[2] += w.luminance;
                    sums[3] += edgeWeights(guide, settings, indirect, {x, y}, i, j).luminance;
                    ++count;
                }
            for (int k = 0; k < 4; ++k)
                if (targets[k]) targets[k]->at(0, x, y) = count > 0 ? sums[k] / static_cast<float>(count) : 1;
        }
    });
}

}  // namespace lumi
