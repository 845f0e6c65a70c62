#include "study/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "base/isa.h"
#include "study/report_resources.h"
#include "study/results.h"
#include "study/run_job.h"
#include "study/temporal_metrics.h"

namespace lumi {
using Json = nlohmann::ordered_json;
namespace {

/// JSON that may stand in a script element: nothing in it closes the element.
std::string scriptJson(const Json& value) {
    const std::string text = value.dump();
    std::string out;
    out.reserve(text.size());
    for (size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '<') out += "\\u003c";
        else out += text[i];
    }
    return out;
}

std::string framesText(const Study& study) {
    const auto& measure = study.frames.measure;
    if (measure.size() == 1) return fmt::format("frame {}", measure.front());
    if (measure.size() == static_cast<size_t>(measure.back() - measure.front() + 1))
        return fmt::format("frames {} to {}", measure.front(), measure.back());
    std::string text = "frames";
    for (size_t i = 0; i < measure.size(); ++i) text += (i ? ", " : " ") + std::to_string(measure[i]);
    return text;
}

template <class List>
std::string joined(const List& list) {
    std::string text;
    for (const auto& item : list) text += (text.empty() ? "" : ", ") + fmt::format("{}", item);
    return text;
}

std::string facts(const Study& study, const StudyRecords& records) {
    std::string size = "the scene's";
    if (study.size.width > 0) size = fmt::format("{} × {}", study.size.width, study.size.height);
    std::string scenes;
    for (const StudyScene& scene : study.scenes) scenes += (scenes.empty() ? "" : ", ") + scene.name;
    const std::pair<std::string, std::string> all[] = {
        {"Preset", study.preset.empty() ? "none" : study.preset},
        {"Scenes", scenes},
        {"Image size", size},
        {"Measured", framesText(study)},
        {"Samples a pixel", joined(study.spp)},
        {"Seeds", joined(study.seeds)},
        {"Reference", fmt::format("{} spp", study.reference.spp)},
        {"Images measured", std::to_string(std::count_if(records.rows.begin(), records.rows.end(),
                                                         [](const StudyRow& row) { return row.frame >= 0; }))}};
    std::string html;
    for (const auto& [name, value] : all)
        html += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>", name, escapedMarkup(value));
    return html;
}

Json studyData(const Study& study, const StudyPlan& plan) {
    Json methods = Json::array();
    for (const StudyMethod& method : plan.methods) {
        Json set = Json::array();
        for (const StudyValue& value : method.set) set.push_back(value.id + " = " + value.text);
        methods.push_back({{"name", method.name},
                           {"entry", study.entries[method.entry].name},
                           {"module", study.entries[method.entry].module},
                           {"set", std::move(set)},
                           {"coordinates", method.coordinates},
                           {"stage", method.stage},
                           {"apart", tracesApart(study, method)}});
    }
    Json axes = Json::array();
    if (study.sweep)
        for (const StudyAxis& axis : study.sweep->axes) axes.push_back({{"id", axis.id}, {"values", axis.values}});
    return {{"seeds", study.seeds},
            {"level", study.intervals.level},
            {"frames", framesText(study)},
            {"axes", std::move(axes)},
            {"methods", std::move(methods)}};
}

Json metricData(const Study& study) {
    Json all = Json::object();
    for (const std::string& id : allMetrics(study)) {
        all[id] = {{"title", titleOf(study, id)},
                   {"definition", definitionOf(study, id)},
                   {"higher", higherIsBetter(study, id)},
                   {"temporal", findTemporalMetric(id) != nullptr}};
        all[id]["squared"] = !isSquaredError(id) ? Json(false) : Json(id == "rmse" ? "root" : "mean");
    }
    return all;
}

/// Metrics of sequences frame by frame, with intervals over the seeds.
Json seriesData(const Study& study, const StudyPlan& plan, const StudyRecords& records) {
    std::map<std::tuple<size_t, int, std::string, size_t>, std::vector<const StudySeries*>> groups;
    for (const StudySeries& one : records.series) groups[{one.scene, one.spp, one.metric, one.method}].push_back(&one);
    Json list = Json::array();
    for (const auto& [key, all] : groups) {
        Json values = Json::array(), low = Json::array(), high = Json::array();
        for (size_t i = 0; i < all.front()->values.size(); ++i) {
            std::vector<double> seeds;
            for (const StudySeries* one : all) seeds.push_back(i < one->values.size() ? one->values[i] : std::nan(""));
            const Json interval = intervalJson(meanInterval(seeds, study.intervals.level));
            values.push_back(interval["mean"]), low.push_back(interval["low"]), high.push_back(interval["high"]);
        }
        list.push_back({{"scene", study.scenes[std::get<0>(key)].name},
                        {"spp", std::get<1>(key)},
                        {"metric", std::get<2>(key)},
                        {"entry", plan.methods[std::get<3>(key)].name},
                        {"begin", all.front()->begin},
                        {"values", std::move(values)},
                        {"low", std::move(low)},
                        {"high", std::move(high)}});
    }
    return list;
}

Json figureData(const ReportContent& content) {
    Json list = Json::array();
    for (const DrawnFigure& figure : content.figures)
        list.push_back({{"name", figure.name}, {"caption", figure.caption}, {"svg", figure.svg}});
    return list;
}

Json latexData(const ReportContent& content) {
    Json list = Json::array();
    for (const LatexTable& table : content.tables)
        list.push_back({{"name", table.name}, {"title", table.title}, {"text", table.text}});
    return list;
}

}  // namespace

std::string escapedMarkup(const std::string& text) {
    std::string out;
    for (const char c : text) switch (c) {
            case '&': out += "&amp;"; break;
            case '<': out += "&lt;"; break;
            case '>': out += "&gt;"; break;
            case '"': out += "&quot;"; break;
            default: out += c;
        }
    return out;
}

std::string filledTemplate(const std::string& page, const std::string& open, const std::string& close,
                           const std::map<std::string, std::string>& values) {
    std::string out;
    for (size_t at = 0; at < page.size();) {
        const size_t begin = page.find(open, at), end = page.find(close, begin);
        if (begin == std::string::npos || end == std::string::npos) return out + page.substr(at);
        out += page.substr(at, begin - at) + values.at(page.substr(begin + open.size(), end - begin - open.size()));
        at = end + close.size();
    }
    return out;
}

std::string studyReport(const Study& study, const StudyPlan& plan, const StudyRecords& records,
                        const ReportContent& content) {
    Json shown = content.results;
    shown.erase("rows");  // the tables need the summaries only; the rows stand in results.csv
    const Json data = {{"study", studyData(study, plan)},
                       {"results", std::move(shown)},
                       {"times", content.times},
                       {"pictures", reportPictures(study, plan, records)},
                       {"series", seriesData(study, plan, records)},
                       {"metrics", metricData(study)},
                       {"figures", figureData(content)},
                       {"latex", latexData(content)}};
    const std::string command = fmt::format("lumiscope study {}{}", study.path.string(),
                                            study.preset.empty() ? "" : " --preset " + study.preset);
    const std::string kicker = "Study" + (study.paper.empty() ? "" : " after " + study.paper);
    return filledTemplate(
        kReportHtml, "{{", "}}",
        {{"title", escapedMarkup(study.title)},
         {"kicker", escapedMarkup(kicker)},
         {"description",
          study.description.empty() ? "" : "<p class=\"lead\">" + escapedMarkup(study.description) + "</p>"},
         {"facts", facts(study, records)},
         {"footer", fmt::format("Made by <code>{}</code> · instruction set {} · study file {}. Numbers of every image "
                                "stand in results.csv and "
                                "results.json beside this file.",
                                escapedMarkup(command), isaName(activeIsa()), study.digest)},
         {"css", kReportCss},
         {"data", scriptJson(data)},
         {"charts", kChartsJs},
         {"viewer", kViewerJs},
         {"report", std::string(kReportJs) + "\n" + kReportTimesJs + "\n" + kReportPageJs}});
}

}  // namespace lumi
