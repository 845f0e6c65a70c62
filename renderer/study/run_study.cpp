#include "study/run_study.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "base/error.h"
#include "base/files.h"
#include "base/isa.h"
#include "base/timer.h"
#include "scene/load.h"
#include "study/report.h"
#include "study/results.h"
#include "study/run_job.h"
#include "study/study_file.h"

namespace lumi {
namespace fs = std::filesystem;
using nlohmann::json;
namespace {

/// Holds the folder while it lives; the kernel lets go of it when the process ends, however it ends.
class FolderLock {
public:
    explicit FolderLock(const fs::path& folder) {
        std::error_code failure;
        fs::create_directories(folder, failure);
        const fs::path path = folder / ".lock";
        file_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
        if (file_ < 0) throwUsage({"cannot be written", folder.string(), "a folder for results", ""});
        if (::flock(file_, LOCK_EX | LOCK_NB) == 0) return;
        ::close(file_);
        throwUsage({"another study runs in this folder", folder.string(), "another folder, or its end", ""});
    }
    ~FolderLock() { ::close(file_); }
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

private:
    int file_;
};

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
        : study_(withScenesThere(study, log)), options_(options), log_(log), lock_(options.out),
          references_(study_, options.referenceCache, log) {
        outcome_.plan = planStudy(study_);
    }

    StudyOutcome run() {
        weighJobs();
        const std::string program = programDigest();
        for (job_ = 0; job_ < outcome_.plan.jobs.size(); ++job_) {
            const StudyJob& job = outcome_.plan.jobs[job_];
            const std::string content = job.definition + sceneOf(job)->contentDigest + isaName(activeIsa()) + program;
            const fs::path folder =
                options_.out / "jobs" /
                (job.id + "-" + digest({reinterpret_cast<const uint8_t*>(content.data()), content.size()}).substr(0, 8));
            folders_.insert(folder.filename().string());
            if (fs::exists(folder / "job.json")) ++outcome_.jobsFound;
            else runJob(job, folder);
            doneWork_ += work_[job_];
            collect(job, folder);
        }
        report(0, "writing the report");
        finish();
        return std::move(outcome_);
    }

private:
    /// Work in samples a pixel: frames, and each reference once.
    void weighJobs() {
        std::set<std::string> known;
        for (const StudyJob& job : outcome_.plan.jobs) {
            const double work = jobWork(study_, job);
            std::string problem = std::to_string(job.scene);
            for (const StudyValue& value : job.sampling)
                if (definesImage(value.id)) problem += value.id + value.text;
            const double frames = job.kind == StudyJob::Kind::Tune ? 1 : static_cast<double>(study_.frames.measure.size());
            const bool isNew = known.insert(problem + (job.kind == StudyJob::Kind::Tune ? " tune" : "")).second;
            referenceWork_.push_back(isNew ? study_.reference.spp : 0);
            work_.push_back(work + frames * referenceWork_.back());
            allWork_ += work_.back();
        }
    }

    std::shared_ptr<const Scene> sceneOf(const StudyJob& job) {
        if (!scene_ || sceneIndex_ != job.scene) {
            const StudyScene& wanted = study_.scenes[job.scene];
            LoadOptions load;
            load.stop = options_.stop;
            for (const StudyValue& value : wanted.set) {
                if (value.id == "scene.variant") load.variant = value.text;
                if (value.id == "scene.index") load.sceneIndex = std::atoi(value.text.c_str());
            }
            report(0, "loading " + wanted.name);
            scene_ = loadScene(findStudyScene(study_, wanted), log_, load);
            sceneIndex_ = job.scene;
        }
        return scene_;
    }

    void runJob(const StudyJob& job, const fs::path& folder) {
        const JobContext context{study_, outcome_.plan, sceneOf(job), references_, log_, options_.stop,
                                 [&](size_t entry, int spp) { return tunedValues(job.scene, entry, spp); },
                                 [&](double fraction, const std::string& step) { report(fraction, step); },
                                 referenceWork_[job_]};
        json times;
        const json result = job.kind == StudyJob::Kind::Tune ? runTuneJob(context, job)
                                                             : runMeasureJob(context, job, folder, options_.out, times);
        writeFileAtomically(folder / "times.json", std::string_view(times.dump(1)));
        writeFileAtomically(folder / "job.json", std::string_view(result.dump(1)));
        ++outcome_.jobsRun;
        workedWork_ += work_[job_];
    }

    /// Every job's results are read from its file, whether it ran now or before.
    void collect(const StudyJob& job, const fs::path& folder) {
        const auto read = [&](const char* name) {
            const json value = json::parse(readTextFile(folder / name), nullptr, false);
            if (value.is_discarded())
                throwBadInput({"is damaged", (folder / name).string(), "what a study wrote; remove it to run the job again", ""});
            return value;
        };
        outcome_.records.add(outcome_.plan, job, read("job.json"), read("times.json"), folder, options_.out);
    }

    std::vector<StudyValue> tunedValues(size_t scene, size_t entry, int spp) const {
        std::vector<StudyValue> values;
        for (const StudyChoice& choice : outcome_.records.choices)
            if (choice.scene == scene && choice.entry == entry && choice.spp == spp)
                for (const auto& [id, text] : choice.values) values.push_back({id, text, study_.path.string()});
        return values;
    }

    void report(double fraction, const std::string& step) {
        if (!options_.progress) return;
        StudyProgress progress{job_, outcome_.plan.jobs.size(), outcome_.jobsFound, step, 0, total_.elapsedMs() / 1000, -1};
        const double inJob = job_ < work_.size() ? fraction * work_[job_] : 0;
        if (job_ < work_.size())
            progress.step = fmt::format("{}: {}", outcome_.plan.jobs[job_].id, step);
        progress.fraction = allWork_ > 0 ? std::min((doneWork_ + inJob) / allWork_, 1.0) : 0;
        const double worked = workedWork_ + inJob;
        if (worked > 0) progress.leftS = progress.elapsedS * (allWork_ - doneWork_ - inJob) / worked;
        options_.progress(progress);
    }

    void finish() {
        outcome_.summaries = summarize(study_, outcome_.plan, outcome_.records);
        const auto write = [&](const char* name, const std::string& text) {
            writeFileAtomically(options_.out / name, std::string_view(text));
            outcome_.files.push_back(options_.out / name);
        };
        const auto results = resultsJson(study_, outcome_.plan, outcome_.records, outcome_.summaries);
        const auto times = timingsJson(study_, outcome_.plan, outcome_.records, outcome_.summaries);
        write("results.csv", resultsCsv(study_, outcome_.plan, outcome_.records));
        write("timings.json", times.dump(1) + "\n");
        write("report.html", studyReport(study_, outcome_.plan, outcome_.records, results, times));
        write("results.json", results.dump(1) + "\n");
        removeOthers();
        outcome_.seconds = total_.elapsedMs() / 1000;
    }

    /// Jobs of an earlier form of the study, and what an interruption left.
    void removeOthers() const {
        std::error_code ignored;
        for (const fs::directory_entry& entry : fs::directory_iterator(options_.out / "jobs", ignored))
            if (!folders_.contains(entry.path().filename().string())) fs::remove_all(entry.path(), ignored);
        std::vector<fs::path> partial;
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(options_.out, ignored))
            if (entry.path().extension() == ".tmp") partial.push_back(entry.path());
        for (const fs::path& path : partial) fs::remove(path, ignored);
    }

    const Study study_;
    const StudyOptions& options_;
    MessageLog& log_;
    FolderLock lock_;
    StudyReferences references_;
    StudyOutcome outcome_;
    std::set<std::string> folders_;
    std::shared_ptr<const Scene> scene_;
    size_t sceneIndex_ = 0, job_ = 0;
    std::vector<double> work_, referenceWork_;
    double allWork_ = 0, doneWork_ = 0, workedWork_ = 0;
    Timer total_;
};

}  // namespace

StudyOutcome runStudy(const Study& study, const StudyOptions& options, MessageLog& log) {
    return StudyRunner(study, options, log).run();
}

}  // namespace lumi
