#include "app/options/subcommand.h"

#include "app/help_text.h"
#include "app/options/shared_options.h"
#include "base/error.h"

namespace lumi {
namespace {

class ReferenceSubcommand : public Subcommand {
public:
    ReferenceSubcommand(CLI::App& parent, CommandLine& line)
        : Subcommand(parent, line, "reference", "Converge an image, kept and resumable") {
        ReferenceCommand& reference = line_.reference;
        app_->add_option("scene", reference.scene.scene, "Scene to render: a name or a path")
            ->required()
            ->type_name("SCENE");
        addShared(*app_, text_, reference.scene);
        app_->get_option("--spp")->description("Samples a pixel (1024)");
        app_->get_option("--module")->description("accumulate, which is what converges");
        app_->add_option("--error", reference.error,
                         "Instead of --spp: go on until the relative standard error is at most this")
            ->type_name("E")
            ->check(between(1e-6, 1e3))
            ->excludes("--spp")
            ->take_last();
        app_->add_option("--samples", samples_, "Only the sums of samples A to B-1, multiples of 16, for `merge`")
            ->type_name("A..B")
            ->excludes("--error")
            ->take_last();
        addCameraPath(*app_, reference.scene);
        app_->add_option("--frames", frames_, "A reference for each of frames 0..N-1, or A..B without B (1)")
            ->type_name("N|A..B")
            ->take_last();
        addRepeatable(
            *app_, "--out", reference.out, "PATH",
            "File to write: .exr or .png, %04d is the frame number; repeatable (<scene>.reference.exr, a free name)");
        app_->add_option("--buffers", reference.buffers, "Signals to add to .exr files as layers, or all")
            ->type_name("NAME,...");
        app_->add_flag("--half", reference.half, "Store colours of .exr files as half");
        progress_.add(*app_);
        addMachine(*app_, line_.machine, true);
        app_->footer(referenceFooter());
    }

    void finish() override {
        line_.command = Command::Reference;
        ReferenceCommand& reference = line_.reference;
        addValues(text_, reference.scene);
        for (const std::string& module : reference.scene.modules)
            if (module != "accumulate")
                throwUsage({"a reference is the mean of its samples", "--module", "accumulate", '"' + module + '"'});
        if (!frames_.empty()) reference.frames = parseFrames(frames_);
        reference.progress = progress_.progress();
        if (samples_.empty()) return;
        reference.samples = parseSamples(samples_, "--samples");
        if (reference.frames.end - reference.frames.begin > 1)
            throwUsage({"a part is one of one image", "--samples", "one frame", ""});
        if (!text_.spp.empty() || !reference.buffers.empty())
            throwUsage({"a part holds just its samples", "--samples", "no --spp and no --buffers beside it", ""});
    }

private:
    SharedText text_;
    std::string samples_, frames_;
    ProgressText progress_;
};

class MergeSubcommand : public Subcommand {
public:
    MergeSubcommand(CLI::App& parent, CommandLine& line)
        : Subcommand(parent, line, "merge", "Add up parts that `reference --samples` wrote") {
        app_->add_option("parts", line_.merge.parts, "Parts whose samples follow each other, in any order")
            ->required()
            ->type_name("PART...");
        app_->add_option("--out", line_.merge.out, "Image (.exr, .png), or a larger part (.lumiref)")
            ->required()
            ->type_name("FILE")
            ->take_last();
        addMachine(*app_, line_.machine, true);
        app_->footer("Example:\n  lumiscope merge a.lumiref b.lumiref --out cornell.exr");
    }

    void finish() override { line_.command = Command::Merge; }
};

}  // namespace

std::unique_ptr<Subcommand> makeReferenceOptions(CLI::App& parent, CommandLine& line) {
    return std::make_unique<ReferenceSubcommand>(parent, line);
}

std::unique_ptr<Subcommand> makeMergeOptions(CLI::App& parent, CommandLine& line) {
    return std::make_unique<MergeSubcommand>(parent, line);
}

}  // namespace lumi
