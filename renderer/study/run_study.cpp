#include "study/run_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <nlohmann/json.hpp>
#include <set>

#include "base/error.h"
#include "base/files.h"
#include "base/isa.h"
#include "base/timer.h"
#include "scene/load.h"
#include "study/figures.h"
#include "study/frame_runner.h"
#include "study/latex.h"
#include "study/report.h"
#include "study/results.h"
#include "study/run_job.h"
#include "study/study_clock.h"
#include "study/study_file.h"
#include "study/study_folder.h"
#include "study/tuning.h"

namespace lumi {
namespace fs = std::filesystem;
using nlohmann::json;
namespace {

/// Results depend on the program that made them.
std::string programDigest() { return digest(readFile("/proc/self/exe")); }

/// Leaves out optional scenes that are not there.
Study withScenesThere(Study study, MessageLog& log) {
    std::erase_if(study.scenes, [&](const StudyScene& scene) {
        if (!scene.optional) return false;
        try {
            findStudyScene(study, scene);
            return false;
        } catch (const Error& error) {
            log.warning(fmt::format("scene \"{}\" is left out: {}", scene.name, error.what()));
            return true;
        }
    });
    if (study.scenes.empty()) throwBadInput({"none of the study's scenes is there", study.path.string(), "", ""});
    return study;
}

class StudyRunner {
public:
    StudyRunner(const Study& study, const StudyOptions& options, MessageLog& log)
        : study_(withScenesThere(study, log)),
          options_(options),
          log_(log),
          folder_(study_, options.out),
          references_(study_, options.referenceCache, log),
          plan_(planStudy(study_)),
          clock_(study_, plan_) {}

    StudyOutcome run() {
        findJobs();
        for (job_ = 0; job_ < plan_.jobs.size(); ++job_) {
            if (!isThere(job_)) runJob(job_);
            collect(job_);
        }
        report("writing the report");
        finish();
        return std::move(outcome_);
    }

private:
    /// Looks at every scene, and whether it takes the values that are set, before hours go into the first: the folder
    /// of a job is named after all that its result depends on.
    void findJobs() {
        const std::string program = programDigest();
        for (job_ = 0; job_ < plan_.jobs.size(); ++job_) {
            const StudyJob& job = plan_.jobs[job_];
            const std::string content = job.definition + sceneOf(job)->contentDigest + isaName(activeIsa()) + program +
                                        checkJobValues(contextOf(job), job);
            folders_.push_back(job.id + "-" +
                               digest({reinterpret_cast<const uint8_t*>(content.data()), content.size()}).substr(0, 8));
            if (!isThere(job_)) continue;
            ++outcome_.jobsFound;
            clock_.found(job_);
        }
    }

    fs::path folderOf(size_t job) const { return options_.out / "jobs" / folders_[job]; }
    bool isThere(size_t job) const { return fs::exists(folderOf(job) / "job.json"); }

    std::shared_ptr<const Scene> sceneOf(const StudyJob& job) {
        if (!scene_ || sceneIndex_ != job.scene) {
            const StudyScene& wanted = study_.scenes[job.scene];
            LoadOptions load;
            load.stop = options_.stop;
            for (const StudyValue& value : wanted.set) load.choice.set(value.id, value.text, value.where);
            report("loading " + wanted.name);
            scene_ = loadScene(findStudyScene(study_, wanted), log_, load);
            sceneIndex_ = job.scene;
        }
        return scene_;
    }

    JobContext contextOf(const StudyJob& job) {
        return {study_,
                plan_,
                sceneOf(job),
                references_,
                log_,
                options_.stop,
                [this, scene = job.scene](size_t entry, int spp) { return tunedValues(scene, entry, spp); },
                [this](double frames, double samples, const std::string& step) {
                    const std::lock_guard lock(reporting_);
                    clock_.at(frames, samples, nowS());
                    tell(step);
                }};
    }

    void runJob(size_t index) {
        const StudyJob& job = plan_.jobs[index];
        const fs::path folder = folderOf(index);
        const JobContext context = contextOf(job);
        clock_.begin(index, nowS());
        json times;
        const json result = job.kind == StudyJob::Kind::Tune ? runTuneJob(context, job)
                                                             : runMeasureJob(context, job, folder, options_.out, times);
        if (result.contains("references")) {
            std::set<std::string> files;
            for (const json& reference : result["references"]) files.insert(reference.at("file").get<std::string>());
            folder_.note(files);
        }
        writeFileAtomically(folder / "times.json", std::string_view(times.dump(1)));
        writeFileAtomically(folder / "job.json", std::string_view(result.dump(1)));
        ++outcome_.jobsRun;
        clock_.end(nowS());
    }

    /// Every job's results are read from its file, whether it ran now or before.
    void collect(size_t index) {
        const fs::path folder = folderOf(index);
        const auto read = [&](const char* name) {
            const json value = json::parse(readTextFile(folder / name), nullptr, false);
            if (value.is_discarded())
                throwBadInput(
                    {"is damaged", (folder / name).string(), "what a study wrote; remove it to run the job again", ""});
            return value;
        };
        outcome_.records.add(plan_, plan_.jobs[index], read("job.json"), read("times.json"), folder, options_.out);
        if (plan_.jobs[index].kind == StudyJob::Kind::Tune) warnOfEnds(outcome_.records.choices.back());
    }

    /// A sigma at the end of its values is not tuned: a wider range may serve the method better.
    void warnOfEnds(StudyChoice& choice) {
        const StudyEntry& entry = study_.entries[choice.entry];
        choice.atEnds = tunedToAnEnd(entry.tune, choice.values);
        for (const auto& [id, text] : choice.values)
            if (std::count(choice.atEnds.begin(), choice.atEnds.end(), id))
                log_.warning(fmt::format(
                    "tuning chose {} {} for \"{}\" on \"{}\", an end of its values: the best may lie beyond it", id,
                    text, entry.name, study_.scenes[choice.scene].name));
    }

    std::vector<StudyValue> tunedValues(size_t scene, size_t entry, int spp) const {
        std::vector<StudyValue> values;
        for (const StudyChoice& choice : outcome_.records.choices)
            if (choice.scene == scene && choice.entry == entry && choice.spp == spp)
                for (const auto& [id, text] : choice.values) values.push_back({id, text, study_.path.string()});
        return values;
    }

    double nowS() const { return total_.elapsedMs() / 1000; }

    void report(const std::string& step) {
        const std::lock_guard lock(reporting_);
        tell(step);
    }
    void tell(const std::string& step) {
        if (!options_.progress) return;
        StudyProgress progress{job_,   plan_.jobs.size(),   outcome_.jobsFound, step, clock_.fraction(),
                               nowS(), clock_.leftS(nowS())};
        if (job_ < plan_.jobs.size()) progress.step = fmt::format("{}: {}", plan_.jobs[job_].id, step);
        options_.progress(progress);
    }

    /// References, figures and tables of the study as it is now.
    std::set<std::string> filesBeside(const std::vector<DrawnFigure>& figures,
                                      const std::vector<LatexTable>& tables) const {
        std::set<std::string> files{"tables/all.tex"};
        for (const DrawnFigure& figure : figures)
            files.insert({"figures/" + figure.name + ".png", "figures/" + figure.name + ".svg"});
        for (const LatexTable& table : tables) files.insert("tables/" + table.name + ".tex");
        for (const StudyReferenceNote& note : outcome_.records.references) files.insert(note.file);
        return files;
    }

    void finish() {
        outcome_.summaries = summarize(study_, plan_, outcome_.records);
        outcome_.times = summarizeTimes(study_, plan_, outcome_.records);
        outcome_.checks = checkClaims(study_, plan_, outcome_.records, outcome_.times);
        const auto write = [&](const std::string& name, std::span<const uint8_t> bytes) {
            writeFileAtomically(options_.out / name, bytes);
            outcome_.files.push_back(options_.out / name);
        };
        const auto writeText = [&](const std::string& name, const std::string& text) {
            write(name, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
        };
        const auto results = resultsJson(study_, plan_, outcome_.records, outcome_.summaries, outcome_.checks);
        const auto times = timingsJson(study_, plan_, outcome_.times, outcome_.checks);
        const std::vector<DrawnFigure> figures = drawFigures(study_, plan_, outcome_.records, log_);
        const std::vector<LatexTable> tables = latexTables(study_, plan_, outcome_.summaries, outcome_.times);
        const std::set<std::string> kept = filesBeside(figures, tables);
        folder_.note(kept);
        for (const DrawnFigure& figure : figures) {
            write("figures/" + figure.name + ".png", figure.png);
            writeText("figures/" + figure.name + ".svg", figure.svg);
        }
        for (const LatexTable& table : tables) writeText("tables/" + table.name + ".tex", table.text);
        writeText("tables/all.tex", latexDocument(study_, figures, tables));
        writeText("results.csv", resultsCsv(study_, plan_, outcome_.records));
        writeText("timings.json", times.dump(1) + "\n");
        writeText("report.html", studyReport(study_, plan_, outcome_.records, {results, times, figures, tables}));
        writeText("results.json", results.dump(1) + "\n");
        folder_.keepOnly({folders_.begin(), folders_.end()}, kept);
        outcome_.study = study_;
        outcome_.plan = plan_;
        outcome_.seconds = nowS();
    }

    const Study study_;
    const StudyOptions& options_;
    MessageLog& log_;
    StudyFolder folder_;
    StudyReferences references_;
    const StudyPlan plan_;
    StudyClock clock_;
    StudyOutcome outcome_;
    std::vector<std::string> folders_;
    std::shared_ptr<const Scene> scene_;
    size_t sceneIndex_ = 0, job_ = 0;
    std::mutex reporting_;
    Timer total_;
};

}  // namespace

StudyOutcome runStudy(const Study& study, const StudyOptions& options, MessageLog& log) {
    return StudyRunner(study, options, log).run();
}

}  // namespace lumi
