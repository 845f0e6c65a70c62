#include "study/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>

#include "reconstruct/catalog.h"

namespace lumi {
namespace {

std::string textOf(const std::vector<StudyValue>& values) {
    std::string text;
    for (const StudyValue& value : values) text += value.id + "=" + value.text + ";";
    return text;
}

std::string textOf(const std::vector<StudyAxis>& axes) {
    std::string text;
    for (const StudyAxis& axis : axes) {
        text += axis.id + "=";
        for (const std::string& value : axis.values) text += value + ",";
        text += ";";
    }
    return text;
}

/// The entries of ablations once more, each time without one stage.
void addStages(const Study& study, std::vector<StudyMethod>& methods) {
    for (const StudyAblation& ablation : study.ablations) {
        const auto whole = std::find_if(methods.begin(), methods.end(), [&](const StudyMethod& method) {
            return study.entries[method.entry].name == ablation.entry && method.coordinates.empty() && !method.whole;
        });
        const size_t index = static_cast<size_t>(whole - methods.begin());
        for (const StudyAblation::Stage& stage : ablation.stages) {
            StudyMethod method = methods[index];
            method.name += " without " + stage.name;
            method.instance = fmt::format("{}@m{}", study.entries[method.entry].module, methods.size());
            method.whole = index;
            method.stage = stage.name;
            for (const StudyValue& value : stage.set) method.set.push_back(value), method.fixed.push_back(value.id);
            methods.push_back(std::move(method));
        }
    }
}

std::vector<StudyMethod> listMethods(const Study& study) {
    std::vector<StudyMethod> methods;
    const auto add = [&](size_t index, const std::vector<StudyValue>& swept, const std::vector<StudyValue>& along) {
        const StudyEntry& entry = study.entries[index];
        StudyMethod method;
        method.entry = index;
        method.name = entry.name;
        method.instance = fmt::format("{}@m{}", entry.module, methods.size());
        method.set = entry.set;
        std::string shown;
        for (const StudyValue& value : swept) {
            method.coordinates.push_back(value.text);
            method.set.push_back(value);
            method.fixed.push_back(value.id);
            shown += (shown.empty() ? "" : ", ") + value.id + "=" + value.text;
        }
        for (const StudyValue& value : along) method.set.push_back(value), method.fixed.push_back(value.id);
        if (!swept.empty()) method.name += " [" + shown + "]";
        methods.push_back(std::move(method));
    };
    for (size_t i = 0; i < study.entries.size(); ++i) {
        const bool swept = study.sweep && (study.sweep->entries.empty() ||
                                           std::count(study.sweep->entries.begin(), study.sweep->entries.end(),
                                                      study.entries[i].name) > 0);
        if (!swept) {
            add(i, {}, {});
            continue;
        }
        const std::vector<std::vector<StudyValue>> points = combinations(study.sweep->axes);
        for (size_t point = 0; point < points.size(); ++point) {
            std::vector<StudyValue> along;
            for (const StudyAxis& axis : study.sweep->with) along.push_back({axis.id, axis.values[point], axis.where});
            add(i, points[point], along);
        }
    }
    addStages(study, methods);
    return methods;
}

/// Values of a method that decide which samples it sees.
std::vector<StudyValue> samplingValues(const Study& study, const StudyMethod& method) {
    std::vector<StudyValue> values;
    for (const StudyValue& value : method.set)
        if (isDocumentId(study.entries[method.entry].module, value.id)) values.push_back(value);
    return values;
}

/// Methods on the same samples: the same document values, and the same offset of camera rays where the scene leaves
/// that to the module.
std::string groupKey(const Study& study, const StudyMethod& method) {
    const auto module = findModule(study.entries[method.entry].module).make();
    return fmt::format("{};{}", static_cast<int>(module->preferredJitter()), textOf(samplingValues(study, method)));
}

std::string commonDefinition(const Study& study, const StudyScene& scene, int spp) {
    std::string text = fmt::format("{};{}x{};frames {}..{};spp {};", scene.source, study.size.width, study.size.height,
                                   study.frames.begin, study.frames.end, spp);
    text += fmt::format("still {};fps {};reference {};", study.frames.still, study.frames.fps, study.reference.spp);
    text += textOf(scene.set) + textOf(study.set) + "ref " + textOf(study.reference.set);
    const MetricSettings& settings = study.metricSettings;
    if (settings != MetricSettings{}) text += fmt::format("relmse {};", settings.relMseEpsilon);
    if (const auto& range = settings.flipExposures)
        text += fmt::format("exposures {} {} {};", range->start, range->stop, range->count);
    if (study.frames.step) text += fmt::format("step {} {}", study.frames.step->frame, textOf(study.frames.step->set));
    return text;
}

std::string measureDefinition(const Study& study, const StudyPlan& plan, const StudyJob& job) {
    std::string text =
        commonDefinition(study, study.scenes[job.scene], job.spp) + fmt::format("seed {};measure ", job.seed);
    for (const int64_t frame : study.frames.measure) text += fmt::format("{},", frame);
    text += fmt::format(";temporal {}..{} from {};", study.frames.temporalBegin, study.frames.temporalEnd,
                        study.frames.temporalMeanFrom);
    for (const std::string& metric : study.metrics) text += metric + ",";
    for (const std::string& metric : study.temporalMetrics) text += metric + ",";
    for (const StudyStatistic& one : study.statistics)
        text += fmt::format("{} {}.{} {} {} {} {} {} {}/{},", one.name, one.tap, one.channel, static_cast<int>(one.of),
                            one.value, one.metric, one.referenceSpp, one.rays, one.over, one.under);
    for (const size_t index : job.methods) {
        const StudyMethod& method = plan.methods[index];
        const StudyEntry& entry = study.entries[method.entry];
        text += fmt::format(";{}={}:{}", method.name, entry.module, textOf(method.set));
        for (const auto& [name, value] : entry.known) text += fmt::format("known {} {};", name, value);
        if (entry.tune.empty()) continue;
        text += fmt::format("tuned {} on {} seed {} ", textOf(entry.tune), study.tuning->metric, study.tuning->seed);
        text += fmt::format("frame {}", study.tuning->frame);
    }
    return text;
}

/// `spp` values of an entry.
const std::vector<int>& sppOf(const Study& study, const StudyEntry& entry) {
    return entry.spp.empty() ? study.spp : entry.spp;
}

std::vector<int> allSpp(const Study& study) {
    std::set<int> all;
    for (const StudyEntry& entry : study.entries) all.insert(sppOf(study, entry).begin(), sppOf(study, entry).end());
    return {all.begin(), all.end()};
}

bool runsAt(const Study& study, const StudyEntry& entry, int spp) {
    const std::vector<int>& own = sppOf(study, entry);
    return std::find(own.begin(), own.end(), spp) != own.end();
}

void addTuning(const Study& study, size_t scene, int spp, StudyPlan& plan) {
    for (size_t i = 0; i < study.entries.size(); ++i) {
        const StudyEntry& entry = study.entries[i];
        if (entry.tune.empty() || !runsAt(study, entry, spp)) continue;
        StudyJob job;
        job.kind = StudyJob::Kind::Tune;
        job.scene = scene, job.spp = spp, job.seed = study.tuning->seed, job.entry = i;
        job.id = fmt::format("{}-spp{}-tune-{}", fileNameOf(study.scenes[scene].name), spp, fileNameOf(entry.name));
        for (const StudyValue& value : entry.set)
            if (isDocumentId(entry.module, value.id)) job.sampling.push_back(value);
        job.definition = commonDefinition(study, study.scenes[scene], spp) +
                         fmt::format("tune {}:{}{} on {} seed {} frame {}", entry.module, textOf(entry.set),
                                     textOf(entry.tune), study.tuning->metric, study.tuning->seed, study.tuning->frame);
        plan.jobs.push_back(std::move(job));
    }
}

/// "a", "b", ... "z", "ba", ...
std::string letters(size_t index) {
    std::string text(1, static_cast<char>('a' + index % 26));
    return index < 26 ? text : letters(index / 26) + text;
}

void addMeasuring(const Study& study, size_t scene, int spp, int seed, StudyPlan& plan) {
    std::vector<std::string> keys;
    std::vector<StudyJob> jobs;
    for (size_t i = 0; i < plan.methods.size(); ++i) {
        const StudyMethod& method = plan.methods[i];
        if (!runsAt(study, study.entries[method.entry], spp)) continue;
        const std::string key = groupKey(study, method);
        size_t group = static_cast<size_t>(std::find(keys.begin(), keys.end(), key) - keys.begin());
        if (group == keys.size()) {
            keys.push_back(key);
            StudyJob job;
            job.scene = scene, job.spp = spp, job.seed = seed;
            job.sampling = samplingValues(study, method);
            job.id = fmt::format("{}-spp{}-seed{}-{}", fileNameOf(study.scenes[scene].name), spp, seed, letters(group));
            jobs.push_back(std::move(job));
        }
        jobs[group].methods.push_back(i);
    }
    for (StudyJob& job : jobs) {
        job.definition = measureDefinition(study, plan, job);
        plan.jobs.push_back(std::move(job));
    }
}

}  // namespace

std::vector<std::vector<StudyValue>> combinations(const std::vector<StudyAxis>& axes) {
    std::vector<std::vector<StudyValue>> all{{}};
    for (const StudyAxis& axis : axes) {
        std::vector<std::vector<StudyValue>> longer;
        for (const std::vector<StudyValue>& begun : all)
            for (const std::string& value : axis.values) {
                longer.push_back(begun);
                longer.back().push_back({axis.id, value, axis.where});
            }
        all = std::move(longer);
    }
    return all;
}

bool isDocumentId(const std::string& module, const std::string& id) {
    const auto instance = findModule(module).make();
    const std::vector<ParameterInfo> declared = listParameters([&](ParameterVisitor& v) { instance->describe(v); });
    return std::none_of(declared.begin(), declared.end(), [&](const ParameterInfo& info) { return info.id == id; });
}

bool tracesApart(const Study& study, const StudyMethod& method) {
    const StudyEntry& entry = study.entries[method.entry];
    for (const StudyAblation& ablation : study.ablations)
        for (const StudyAblation::Stage& stage : ablation.stages)
            if (method.whole && ablation.entry == entry.name && stage.name == method.stage)
                return std::any_of(stage.set.begin(), stage.set.end(),
                                   [&](const StudyValue& value) { return isDocumentId(entry.module, value.id); });
    return false;
}

std::string fileNameOf(const std::string& name) {
    std::string text;
    for (const unsigned char c : name) text += std::isalnum(c) || c == '-' || c == '.' ? static_cast<char>(c) : '-';
    return text;
}

StudyPlan planStudy(const Study& study) {
    StudyPlan plan;
    plan.methods = listMethods(study);
    for (size_t scene = 0; scene < study.scenes.size(); ++scene)
        for (const int spp : allSpp(study)) {
            addTuning(study, scene, spp, plan);
            for (const int seed : study.seeds) addMeasuring(study, scene, spp, seed, plan);
        }
    return plan;
}

int64_t lastFrame(const Study& study, StudyJob::Kind kind) {
    if (kind == StudyJob::Kind::Tune) return study.tuning->frame;
    if (study.measures("lag")) return study.frames.end - 1;
    return std::max(study.frames.measure.back(), study.temporalMetrics.empty() ? 0 : study.frames.temporalEnd - 1);
}

}  // namespace lumi
