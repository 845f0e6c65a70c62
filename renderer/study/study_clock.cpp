#include "study/study_clock.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "study/run_job.h"
#include "study/study_file.h"
#include "study/tuning.h"

namespace lumi {
namespace {

/// A method's run, against a sample of every pixel: only until the first job of a kind has told.
constexpr double kMethodWork = 0.5;

}  // namespace

StudyClock::StudyClock(const Study& study, const StudyPlan& plan) {
    std::set<std::string> known;
    for (const StudyJob& job : plan.jobs) {
        Job own;
        own.scene = job.scene;
        const bool tunes = job.kind == StudyJob::Kind::Tune;
        const TuningEffort effort =
            tunes ? tuningEffort(study.entries[job.entry].tune) : TuningEffort{1, job.methods.size()};
        const size_t methods = effort.places;
        const double frames = static_cast<double>(lastFrame(study, job.kind) - study.frames.begin + 1);
        own.frames = frames * (job.spp * static_cast<double>(effort.runs) + kMethodWork * static_cast<double>(methods));
        own.kind = fmt::format("{} {} {}", job.scene, job.spp, methods);
        // What a reference is of. The second job that compares with it finds it.
        std::string problem = std::to_string(job.scene);
        for (const StudyValue& value : job.sampling) {
            own.kind += value.id + value.text;
            if (definesImage(value.id)) problem += value.id + value.text;
        }
        if (tunes) problem += " tune", own.kind += " tune " + study.entries[job.entry].name;
        else
            for (const size_t method : job.methods) own.kind += fmt::format(",{}", method);
        if (known.insert(problem).second)
            own.references = static_cast<double>(referencesOf(study, job)) * study.reference.spp;
        jobs_.push_back(std::move(own));
    }
}

void StudyClock::found(size_t job) { jobs_[job].done = true; }

void StudyClock::begin(size_t job, double nowS) {
    current_ = job, running_ = true, lastS_ = nowS;
    frameShare_ = referenceSamples_ = framesS_ = referencesS_ = 0;
}

void StudyClock::at(double frameShare, double referenceSamples, double nowS) {
    referenceSamples = std::min(referenceSamples, jobs_[current_].references);
    // Whatever went on since the last word counts to what has grown.
    (referenceSamples > referenceSamples_ ? referencesS_ : framesS_) += nowS - lastS_;
    frameShare_ = frameShare, referenceSamples_ = referenceSamples, lastS_ = nowS;
}

void StudyClock::end(double nowS) {
    framesS_ += nowS - lastS_;
    Job& job = jobs_[current_];
    job.done = true, job.framesS = framesS_, job.referencesS = referencesS_;
    running_ = false;
}

double StudyClock::expectedFramesS(const Job& job) const {
    double seconds[2] = {0, 0}, frames[2] = {0, 0};  // of all scenes, of the job's
    const auto add = [&](const Job& other, double spentS, double share) {
        for (int i = 0; i < (other.scene == job.scene ? 2 : 1); ++i)
            seconds[i] += spentS, frames[i] += other.frames * share;
    };
    for (const Job& other : jobs_) {
        if (other.framesS < 0) continue;
        if (other.kind == job.kind) return other.framesS;
        add(other, other.framesS, 1);
    }
    if (running_ && frameShare_ > 0.05) add(jobs_[current_], framesS_, frameShare_);
    if (frames[1] > 0) return seconds[1] / frames[1] * job.frames;
    return frames[0] > 0 ? seconds[0] / frames[0] * job.frames : -1;
}

double StudyClock::expectedReferencesS(const Job& job) const {
    if (job.references <= 0) return 0;
    double seconds[2] = {0, 0}, samples[2] = {0, 0};
    const auto add = [&](const Job& other, double spentS, double traced) {
        for (int i = 0; i < (other.scene == job.scene ? 2 : 1); ++i) seconds[i] += spentS, samples[i] += traced;
    };
    for (const Job& other : jobs_)
        if (other.referencesS >= 0) add(other, other.referencesS, other.references);
    if (running_) add(jobs_[current_], referencesS_, referenceSamples_);
    if (samples[1] > 0) return seconds[1] / samples[1] * job.references;
    return samples[0] > 0 ? seconds[0] / samples[0] * job.references : -1;
}

bool StudyClock::knowsAll() const {
    return std::all_of(jobs_.begin(), jobs_.end(), [&](const Job& job) {
        return job.done || (expectedFramesS(job) >= 0 && expectedReferencesS(job) >= 0);
    });
}

double StudyClock::fraction() {
    // In seconds as soon as they are known of all kinds of work; until then in samples.
    const bool timed = knowsAll();
    double done = 0, all = 0;
    for (size_t i = 0; i < jobs_.size(); ++i) {
        const Job& job = jobs_[i];
        const double frames = timed ? std::max(job.framesS >= 0 ? job.framesS : expectedFramesS(job), 0.0) : job.frames;
        const double references =
            timed ? std::max(job.referencesS >= 0 ? job.referencesS : expectedReferencesS(job), 0.0) : job.references;
        all += frames + references;
        if (job.done) done += frames + references;
        else if (running_ && i == current_)
            done += frames * frameShare_ + (job.references > 0 ? references * referenceSamples_ / job.references : 0);
    }
    shown_ = std::max(shown_, all > 0 ? std::clamp(done / all, 0.0, 1.0) : 0);
    return shown_;
}

double StudyClock::leftS(double nowS) const {
    if (!knowsAll()) return -1;
    double left = 0;
    for (size_t i = 0; i < jobs_.size(); ++i) {
        const Job& job = jobs_[i];
        if (job.done) continue;
        const bool current = running_ && i == current_;
        const double traced = current && job.references > 0 ? referenceSamples_ / job.references : 0;
        left += expectedFramesS(job) * (current ? 1 - frameShare_ : 1) + expectedReferencesS(job) * (1 - traced);
    }
    return std::max(left - (running_ ? nowS - lastS_ : 0), 0.0);
}

}  // namespace lumi
