#include "app/options/subcommand.h"

#include "app/help_text.h"
#include "app/options/shared_options.h"

namespace lumi {
namespace {

class CompareSubcommand : public Subcommand {
public:
    CompareSubcommand(CLI::App& parent, CommandLine& line)
        : Subcommand(parent, line, "compare", "Measure how far an image is from its reference") {
        CompareOptions& compare = line_.compare;
        app_->add_option("image", compare.image,
                         "Image to judge: .exr, .hdr, .png, .jpg, .bmp or .tga; frames as a.%04d.exr")
            ->required()
            ->type_name("IMAGE");
        app_->add_option("reference", compare.reference, "What it should be, of the same size")
            ->required()
            ->type_name("REFERENCE");
        app_->add_option("--metrics", metrics_, "Only these, as `list metrics` names them (all)")
            ->type_name("NAME,...")
            ->take_last();
        app_->add_option("--maps", compare.maps,
                         "Folder for error maps, .exr and in false colour .png; made if missing")
            ->type_name("DIR")
            ->take_last();
        app_->add_option("--crop", crop_, "Only this part of both, in pixels from the top left")
            ->type_name("X,Y,W,H")
            ->take_last();
        app_->add_option("--mask", compare.mask, "Image of the same size: only where its luminance is above 0.5")
            ->type_name("FILE")
            ->take_last();
        app_->add_option("--exposure", compare.exposureEv,
                         "Stops, for metrics that judge images as shown (those in the files' state, else 0)")
            ->type_name("EV")
            ->check(between(-100.0, 100.0))
            ->take_last();
        app_->add_option("--flip-exposures", flipExposures_,
                         "Exposure range of HDR-FLIP in stops (what the reference says)")
            ->type_name("START,STOP[,COUNT]")
            ->take_last();
        app_->add_option("--relmse-epsilon", compare.settings.relMseEpsilon,
                         "Added to the squared gray reference in relMSE (0.001)")
            ->type_name("E")
            ->check(between(1e-12, 1e6))
            ->take_last();
        app_->add_option("--frames", frames_, "Of frames: 0..N-1, or A..B without B (those there are)")
            ->type_name("N|A..B")
            ->take_last();
        addMachine(*app_, line_.machine, true);
        app_->footer(compareFooter());
    }

    void finish() override {
        line_.command = Command::Compare;
        line_.compare.metrics = splitList(metrics_);
        if (!crop_.empty()) line_.compare.crop = parseCrop(crop_, "--crop");
        if (!flipExposures_.empty())
            line_.compare.settings.flipExposures = parseFlipExposures(flipExposures_, "--flip-exposures");
        if (!frames_.empty()) {
            const FrameRange frames = parseFrames(frames_);
            line_.compare.frames = {frames.begin, frames.end};
        }
        line_.compare.json = line_.machine.json;
        line_.compare.quiet = line_.machine.quiet;
    }

private:
    std::string metrics_, crop_, flipExposures_, frames_;
};

}  // namespace

std::unique_ptr<Subcommand> makeCompareOptions(CLI::App& parent, CommandLine& line) {
    return std::make_unique<CompareSubcommand>(parent, line);
}

}  // namespace lumi
