#include "app/options/subcommand.h"

#include "app/help_text.h"
#include "app/options/shared_options.h"

namespace lumi {
namespace {

class StudySubcommand : public Subcommand {
public:
    StudySubcommand(CLI::App& parent, CommandLine& line)
        : Subcommand(parent, line, "study", "Run a study: scenes, methods and metrics, with a report") {
        app_->add_option("file", line_.study.file, "Study to run: a name or a path")->required()->type_name("FILE");
        app_->add_option("--preset", line_.study.preset, "Size of the study: quick (if it has that), paper, or another")
            ->type_name("NAME")
            ->take_last();
        app_->add_option("--out", line_.study.out, "Folder for results, resumed if it holds some (<study>-<preset>)")
            ->type_name("DIR")
            ->take_last();
        progress_.add(*app_);
        addMachine(*app_, line_.machine, true);
        app_->footer(studyFooter());
    }

    void finish() override {
        line_.command = Command::Study;
        line_.study.progress = progress_.progress();
    }

private:
    ProgressText progress_;
};

class BenchSubcommand : public Subcommand {
public:
    BenchSubcommand(CLI::App& parent, CommandLine& line)
        : Subcommand(parent, line, "bench", "Measure speed and memory against bare Embree and memory bandwidth") {
        app_->add_option("--filter", line_.filter, "Only entries in whose name this regular expression is found")
            ->type_name("RE")
            ->take_last();
        app_->add_flag("--check", line_.check, "Exit with 1 where a mark (mark/...) is missed");
        addMachine(*app_, line_.machine, true);
        app_->footer(benchFooter);
    }

    void finish() override { line_.command = Command::Bench; }
};

}  // namespace

std::unique_ptr<Subcommand> makeStudyOptions(CLI::App& parent, CommandLine& line) {
    return std::make_unique<StudySubcommand>(parent, line);
}

std::unique_ptr<Subcommand> makeBenchOptions(CLI::App& parent, CommandLine& line) {
    return std::make_unique<BenchSubcommand>(parent, line);
}

}  // namespace lumi
