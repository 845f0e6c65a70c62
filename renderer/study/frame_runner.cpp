#include "study/frame_runner.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "study/study_file.h"

namespace lumi {
namespace {

/// In a study file a value that does not fit is bad input, wherever it is found.
void setValue(Document& document, const std::string& id, const std::string& text, const std::string& where) {
    try {
        document.setText(id, text, where);
    } catch (const Error& error) {
        throw Error(error.kind() == ErrorKind::Usage ? ErrorKind::BadInput : error.kind(), error.text());
    }
}

void setAll(Document& document, const std::vector<StudyValue>& values) {
    for (const StudyValue& value : values) setValue(document, value.id, value.text, value.where);
}

void setDefining(Document& document, const std::vector<StudyValue>& values) {
    for (const StudyValue& value : values)
        if (definesImage(value.id)) setValue(document, value.id, value.text, value.where);
}

/// The scene at the study's size.
Document baseDocument(const JobContext& context) {
    Document document(context.scene);
    const Study& study = context.study;
    if (study.size.width > 0) {
        setValue(document, "render.width", std::to_string(study.size.width), study.path.string());
        setValue(document, "render.height", std::to_string(study.size.height), study.path.string());
    }
    // The engine takes a step that is longer than the document's own for a jump, which drops every history.
    if (study.frames.fps > 0)
        setValue(document, "render.fps", fmt::format("{}", study.frames.fps), study.path.string());
    setValue(document, "view.layout", "single", study.path.string());
    setValue(document, "view.0.buffer", "image", study.path.string());
    return document;
}

/// What a reference of the job is a rendering of.
Document problemDocument(const JobContext& context, const StudyJob& job) {
    Document document = baseDocument(context);
    setDefining(document, context.study.scenes[job.scene].set);
    setDefining(document, context.study.set);
    setDefining(document, job.sampling);
    setAll(document, context.study.reference.set);
    return document;
}

Document jobDocument(const JobContext& context, const StudyJob& job, const std::vector<RunningMethod>& methods) {
    Document document = baseDocument(context);
    setAll(document, context.study.scenes[job.scene].set);
    setAll(document, context.study.set);
    setAll(document, job.sampling);
    setValue(document, "render.spp", std::to_string(job.spp), context.study.path.string());
    setValue(document, "render.seed", std::to_string(job.seed), context.study.path.string());
    for (const RunningMethod& method : methods)
        for (const StudyValue& value : method.set)
            setValue(document, method.instance + "." + value.id, value.text, value.where);
    // The first view's module decides the offset of camera rays; all methods of a job want the same.
    setValue(document, "view.0.module", methods.front().instance, context.study.path.string());
    return document;
}

float timeOf(const Study& study, const Document& document, int64_t frame) {
    const int64_t shown = study.frames.still ? study.frames.begin : frame;
    // A scene that is shown as a single still picture keeps the time that its document has.
    if (study.frames.begin == 0 && (study.frames.still || study.frames.end == 1)) return document.time();
    return static_cast<float>(static_cast<double>(shown) / document.render().fps);
}

}  // namespace

std::vector<RunningMethod> methodsOf(const JobContext& context, const StudyJob& job) {
    std::vector<RunningMethod> methods;
    for (const size_t index : job.methods) {
        const StudyMethod& method = context.plan.methods[index];
        const StudyEntry& entry = context.study.entries[method.entry];
        RunningMethod running{method.instance, {}};
        for (const StudyValue& value : method.set)
            if (!isDocumentId(entry.module, value.id)) running.set.push_back(value);
        if (!entry.tune.empty())
            for (const StudyValue& value : context.tuned(method.entry, job.spp))
                if (!std::count(method.fixed.begin(), method.fixed.end(), value.id)) running.set.push_back(value);
        methods.push_back(std::move(running));
    }
    return methods;
}

FrameRunner::FrameRunner(const JobContext& context, const StudyJob& job, std::vector<RunningMethod> methods)
    : context_(context),
      methods_(std::move(methods)),
      document_(jobDocument(context, job, methods_)),
      problem_(problemDocument(context, job)),
      earlier_(problem_),
      engine_(context.log),
      next_(context.study.frames.begin) {}

std::string checkJobValues(const JobContext& context, const StudyJob& job) {
    std::vector<RunningMethod> methods;
    if (job.kind == StudyJob::Kind::Tune) methods.push_back({context.study.entries[job.entry].module + "@t0", {}});
    else methods = methodsOf(context, job);
    Document document = jobDocument(context, job, methods), problem = problemDocument(context, job);
    std::string images = document.environmentDigest() + ' ' + problem.environmentDigest();
    if (const auto& step = context.study.frames.step) {
        setAll(document, step->set), setAll(problem, step->set);
        images += ' ' + document.environmentDigest() + ' ' + problem.environmentDigest();
    }
    return images;
}

FrameOutput FrameRunner::advance(const SignalSet& signals, const std::map<std::string, TapSet>& taps) {
    const int64_t number = next_++;
    earlier_ = problem_;
    if (const auto& step = context_.study.frames.step; step && step->frame == number) {
        setAll(document_, step->set);
        setAll(problem_, step->set);
    }
    const float time = timeOf(context_.study, document_, number);
    document_.setTime(time);
    problem_.setTime(time);
    if (number == context_.study.frames.begin) earlier_ = problem_;  // nothing was before
    FrameRequest request{document_, number, number == context_.study.frames.begin, signals, taps};
    for (const RunningMethod& method : methods_) request.instances.push_back(method.instance);
    std::optional<FrameOutput> frame = engine_.advance(request, context_.stop, context_.stop);
    if (!frame) throw Error(ErrorKind::Interrupted, {"interrupted", "", "", ""});
    return std::move(*frame);
}

std::shared_ptr<const Signals> FrameRunner::geometry() {
    const auto signals = context_.references.geometry(problem_, earlier_, [&](const FrameSampling& sampling) {
        return engine_.sampleAgain(sampling, context_.stop);
    });
    if (!signals) throw Error(ErrorKind::Interrupted, {"interrupted", "", "", ""});
    return signals;
}

std::shared_ptr<const StudyReferenceFrame> FrameRunner::reference(const StudyReferences::Report& report, int spp) {
    return context_.references.get(problem_, context_.stop, report, spp);
}

}  // namespace lumi
