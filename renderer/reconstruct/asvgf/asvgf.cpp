#include "reconstruct/asvgf/asvgf.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace lumi {
namespace {

std::vector<Tap> gradientTaps() {
    return {{.name = "gradientSample",
             .channels = "Y",
             .range = ValueRange{0, 1},
             .colourMap = "gray",
             .help = "1 in strata whose sample of the frame before was shaded again"},
            {.name = "directGradient",
             .channels = "Y",
             .unit = "W/(m^2 sr)",
             .colourMap = "signed",
             .help = "Direct light of that sample now minus then, before the filter"},
            {.name = "indirectGradient",
             .channels = "Y",
             .unit = "W/(m^2 sr)",
             .colourMap = "signed",
             .help = "Indirect light of that sample now minus then, before the filter"},
            {.name = "directLoss",
             .channels = "Y",
             .range = ValueRange{0, 1},
             .colourMap = "magma",
             .help = "lambda: how much of the history of direct light is given up"},
            {.name = "indirectLoss",
             .channels = "Y",
             .range = ValueRange{0, 1},
             .colourMap = "magma",
             .help = "lambda: how much of the history of indirect light is given up"}};
}

/// Geometry at the middle of each stratum; slopes are per stratum.
void sampleGuide(const Signals& signals, Image& guide) {
    const Extent2 extent = signals.extent(), strata = strataOf(extent);
    if (guide.extent() != strata) guide.reset(strata, 6);
    for (int y = 0; y < strata.height; ++y)
        for (int x = 0; x < strata.width; ++x) {
            const int px = std::min(x * kStratum + 1, extent.width - 1),
                      py = std::min(y * kStratum + 1, extent.height - 1);
            guide.at(0, x, y) = signals[Signal::InverseDepth].at(0, px, py);
            for (int c = 0; c < 2; ++c) guide.at(1 + c, x, y) = kStratum * signals[Signal::DepthGradient].at(c, px, py);
            for (int c = 0; c < 3; ++c) guide.at(3 + c, x, y) = signals[Signal::Normal].at(c, px, py);
        }
}

SurfaceGuide guideOf(const Image& image) {
    SurfaceGuide guide;
    guide.width = image.width();
    guide.height = image.height();
    guide.inverseDepth = image.plane(0).data;
    guide.slopeX = image.plane(1).data;
    guide.slopeY = image.plane(2).data;
    for (int c = 0; c < 3; ++c) guide.normal[c] = image.plane(3 + c).data;
    return guide;
}

}  // namespace

AsvgfModule::AsvgfModule() : SvgfModule(gradientTaps()) { useAlpha(0.1f); }

void AsvgfModule::describe(ParameterVisitor& v) {
    v.integer("gradient-levels", levels_,
              {.label = "Gradient levels",
               .min = 0,
               .max = 7,
               .help = "Iterations of the à-trous transform over the strata's differences (sec. 4.3)"});
    v.number("gradient-strength", strength_,
             {.label = "Gradient strength",
              .min = 0,
              .max = 4,
              .help = "Factor on lambda, the relative difference that moves alpha towards 1 (sec. 4.4); 0 is SVGF"});
    SvgfModule::describe(v);
}

void AsvgfModule::forget() {
    SvgfModule::forget();
    samples_.clear();
}

bool AsvgfModule::estimateLoss(const FrameContext& context, HistoryLoss& loss) {
    const auto measured = context.timer.measure("gradients");
    auto step = samples_.begin(context.frame, context.changes.cut);
    std::vector<ReshadedSample> reshaded;
    bool stopped = false;
    if (step.previous) reshaded = reshade(context, *step.previous, stopped);
    if (stopped || !filterStrata(context, reshaded)) return false;
    step.next = drawGradientSamples(context, frame().direct, frame().indirect);
    if (step.next.empty() && extent().area() > 0) return false;
    loss = {&loss_[0], &loss_[1]};
    keepTaps(reshaded);
    return true;
}

bool AsvgfModule::filterStrata(const FrameContext& context, const std::vector<ReshadedSample>& samples) {
    const Extent2 strata = strataOf(extent());
    sampleGuide(context.signals, guide_);
    for (int c = 0; c < 2; ++c) {
        Illumination& planes = strata_[0][c];
        planes.reset(strata);
        planes.rgb.fill(0);
        planes.luminance.fill(0);
        for (const ReshadedSample& sample : samples) {
            const float before = c == 0 ? sample.before.direct : sample.before.indirect,
                        now = c == 0 ? sample.now.direct : sample.now.indirect;
            planes.rgb.data()[sample.stratum] = now - before;
            planes.rgb.plane(1).data[sample.stratum] = std::max(now, before);
        }
    }
    AtrousSettings settings;
    settings.edges.sigmaLuminance = 1e15f;  // differences are noise: they do not stop at their own edges
    settings.variancePrefilter = false;
    int from = 0;
    for (int level = 0; level < levels_; ++level, from = 1 - from)
        if (!atrousLevel(guideOf(guide_), settings, 1 << level, {&strata_[from][0], &strata_[from][1]},
                         {&strata_[1 - from][0], &strata_[1 - from][1]}, context.stop))
            return false;
    for (int c = 0; c < 2; ++c) {
        const Image& filtered = strata_[from][c].rgb;
        if (loss_[c].extent() != extent()) loss_[c].reset(extent(), 1);
        parallelFor(extent().height, [&](int64_t row) {
            const int y = static_cast<int>(row);
            for (int x = 0; x < extent().width; ++x) {
                const float greater = filtered.at(1, x / kStratum, y / kStratum);
                const float relative =
                    greater > 1e-8f ? std::fabs(filtered.at(0, x / kStratum, y / kStratum)) / greater : 0;
                loss_[c].at(0, x, y) = std::min(1.0f, strength_ * relative);
            }
        });
    }
    return true;
}

void AsvgfModule::keepTaps(const std::vector<ReshadedSample>& samples) {
    captured().keep("directLoss", loss_[0]);
    captured().keep("indirectLoss", loss_[1]);
    const Extent2 strata = strataOf(extent());
    const auto fill = [&](const char* name, auto valueOf) {
        Image* image = captured().target(name);
        if (!image) return;
        image->reset(extent(), 1);
        for (const ReshadedSample& sample : samples) {
            const int left = static_cast<int>(sample.stratum % static_cast<size_t>(strata.width)) * kStratum;
            const int top = static_cast<int>(sample.stratum / static_cast<size_t>(strata.width)) * kStratum;
            for (int y = top; y < std::min(top + kStratum, extent().height); ++y)
                for (int x = left; x < std::min(left + kStratum, extent().width); ++x)
                    image->at(0, x, y) = valueOf(sample);
        }
    };
    fill("gradientSample", [](const ReshadedSample&) { return 1.0f; });
    fill("directGradient", [](const ReshadedSample& s) { return s.now.direct - s.before.direct; });
    fill("indirectGradient", [](const ReshadedSample& s) { return s.now.indirect - s.before.indirect; });
}

size_t AsvgfModule::byteCount() const {
    size_t sum = SvgfModule::byteCount() + guide_.bytes() + loss_[0].bytes() + loss_[1].bytes();
    for (const auto& levels : strata_)
        for (const Illumination& planes : levels) sum += planes.bytes();
    return sum +
           samples_.byteCount([](const std::vector<GradientSample>& s) { return s.size() * sizeof(GradientSample); });
}

}  // namespace lumi
