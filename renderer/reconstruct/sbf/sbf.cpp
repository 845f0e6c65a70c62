#include "reconstruct/sbf/sbf.h"

namespace lumi {
namespace {

std::vector<Tap> declareTaps() {
    std::vector<Tap> taps = temporalTaps();
    taps.push_back({.name = "input",
                    .channels = "RGB",
                    .unit = "W/(m^2 sr)",
                    .colourMap = "none",
                    .help = "Illumination that the bank filters"});
    taps.push_back({.name = "sampleVariance",
                    .channels = "Y",
                    .colourMap = "magma",
                    .help = "Variance of a pixel's colour, from its window"});
    taps.push_back(
        {.name = "choice",
         .channels = "Y",
         .range = ValueRange{0, 3},
         .help = "The filter that is taken: 0 is sigma_s of 1 pixel, 3 is 8; between them where neighbours differ"});
    for (int f = 0; f < CrossBilateralRow::kMost; ++f) {
        const std::string number = std::to_string(f), sigma = std::to_string(1 << f);
        taps.push_back({.name = "filtered" + number,
                        .channels = "RGB",
                        .unit = "W/(m^2 sr)",
                        .colourMap = "none",
                        .help = "Illumination by a sigma_s of this filter alone"});
        taps.push_back({.name = "error" + number,
                        .channels = "Y",
                        .colourMap = "signed",
                        .help = "Its estimated squared error (SURE), which noise may make negative"});
    }
    return taps;
}

}  // namespace

SbfModule::SbfModule() : ScreenFilter(declareTaps(), false) {}

void SbfModule::describe(ParameterVisitor& v) {
    input_.describe(v);
    v.integer("filters", settings_.filters,
              {.label = "Filters",
               .min = 1,
               .max = CrossBilateralRow::kMost,
               .help = "Of the bank, with sigma_s of 1, 2, 4 and 8 pixels"});
    v.integer("variance-radius", settings_.varianceRadius,
              {.label = "Variance radius",
               .min = 1,
               .max = 5,
               .unit = "px",
               .help = "Of the window that a pixel's variance is estimated in"});
    v.number("sigma-color", settings_.sigmaColour,
             {.label = "Sigma colour",
              .min = 0.1,
              .max = 1000,
              .scale = Scale::Log,
              .help = "sigma_r, in standard deviations of a pixel's colour"});
    v.number("sigma-normal", settings_.sigmaNormal,
             {.label = "Sigma normal", .min = 0.01, .max = 10, .scale = Scale::Log, .help = "sigma_f of normals"});
    v.number("sigma-albedo", settings_.sigmaAlbedo,
             {.label = "Sigma albedo",
              .min = 0.01,
              .max = 10,
              .scale = Scale::Log,
              .help = "sigma_f of albedos, the paper's textures"});
    v.number("sigma-depth", settings_.sigmaDepth,
             {.label = "Sigma depth",
              .min = 0.001,
              .max = 10,
              .scale = Scale::Log,
              .help = "sigma_f of depth, as a part of it"});
    describeAntialiasing(v);
}

bool SbfModule::filter(const FrameContext& context, const Step& step, Image& out) {
    const Image* input = input_.integrate(context, frame(), step.previous, step.next, captured(), inspected());
    if (!input) return false;
    const auto measured = context.timer.measure("cross-bilateral bank");
    if (!chooseBySure(context.signals, frame().albedo, settings_, *input, bank_, filtered_, context.stop)) return false;
    captured().keep("input", *input);
    captured().keep("sampleVariance", bank_.variance);
    captured().keep("choice", bank_.choice);
    for (size_t f = 0; f < CrossBilateralRow::kMost; ++f) {
        captured().keep("filtered" + std::to_string(f), bank_.filtered[f]);
        captured().keep("error" + std::to_string(f), bank_.error[f]);
    }
    remodulate(frame(), filtered_, nullptr, out);
    return true;
}

size_t SbfModule::byteCount() const {
    return ScreenFilter::byteCount() + input_.byteCount() + bank_.bytes() + filtered_.bytes();
}

}  // namespace lumi
