#include <nlohmann/json.hpp>

#include "measure/measure.h"
#include "study/study_file.h"
#include "study/temporal_metrics.h"

namespace lumi {
namespace {

using Json = nlohmann::ordered_json;

Json text(const char* help) { return {{"type", "string"}, {"description", help}}; }
Json whole(int64_t min, int64_t max, const char* help) {
    return {{"type", "integer"}, {"minimum", min}, {"maximum", max}, {"description", help}};
}
Json listOf(Json item, const char* help, int least = 1) {
    return {{"type", "array"}, {"items", std::move(item)}, {"minItems", least}, {"description", help}};
}
/// One whole number, or several that differ.
Json wholes(int64_t min, int64_t max, const char* help) {
    Json one = {{"type", "integer"}, {"minimum", min}, {"maximum", max}};
    Json many = listOf(one, help);
    many["uniqueItems"] = true;
    return {{"description", help}, {"anyOf", {one, std::move(many)}}};
}
Json closed(Json properties, const char* help, std::vector<std::string> required = {}) {
    Json schema = {{"type", "object"},
                   {"description", help},
                   {"properties", std::move(properties)},
                   {"additionalProperties", false}};
    if (!required.empty()) schema["required"] = required;
    return schema;
}
Json mapOf(Json entry, const char* help) {
    return {{"type", "object"}, {"description", help}, {"additionalProperties", std::move(entry)}};
}
Json reference(const char* name) { return {{"$ref", std::string("#/$defs/") + name}}; }
Json oneOfNames(const std::vector<std::string>& names, const char* help) {
    return {{"enum", names}, {"description", help}};
}

std::vector<std::string> metricIds(bool temporal, bool mapsOnly = false) {
    std::vector<std::string> ids;
    for (const Metric& metric : metricCatalog())
        if (!mapsOnly || metric.mapColours) ids.emplace_back(metric.id);
    if (temporal)
        for (const TemporalMetric& metric : temporalMetricCatalog()) ids.emplace_back(metric.id);
    return ids;
}

Json sceneSchema() {
    const char* help = "A built-in name, a path relative to this file, or assets: and a path under $LUMISCOPE_ASSETS.";
    Json full = closed(
        {{"scene", text(help)},
         {"name", text("What results call it; by default the name of its file.")},
         {"optional", {{"type", "boolean"}, {"description", "Left out, with a warning, where it is not found."}}},
         {"set", reference("values")}},
        "A scene with parameters.", {"scene"});
    return {{"anyOf", {text(help), std::move(full)}}};
}

Json entrySchema() {
    return closed({{"name", text("What results call it; by default the module's id.")},
                   {"module", text("Which method, as `lumiscope list modules` names it.")},
                   {"set", reference("values")},
                   {"tune", reference("axes")},
                   {"spp", wholes(1, 65536, "Samples a pixel and frame, instead of the study's.")},
                   {"known", mapOf({{"type", "number"}}, "Statistics that are so by construction.")}},
                  "A method with parameters: ids of its module, or ids with a dot of the document.", {"module"});
}

Json framesSchema() {
    constexpr int64_t last = 10'000'000;
    Json pair = listOf({{"type", "integer"}, {"minimum", 0}}, "First frame, and the one after the last.", 2);
    pair["maxItems"] = 2;
    return closed(
        {{"range", pair},
         {"measure",
          {{"description", "Frames that are compared with a reference; by default the last."},
           {"anyOf", {wholes(0, last, "Frame numbers."), Json{{"const", "all"}}}}}},
         {"temporal", pair},
         {"mean-from",
          whole(1, last,
                "Of the frames of \"temporal\" the first that counts for the mean; those before it are shown only.")},
         {"step",
          closed({{"frame", whole(1, last, "The first frame that has the values.")}, {"set", reference("values")}},
                 "From a frame on parameters of the scene have other values; \"lag\" measures how long the methods "
                 "take to follow.",
                 {"frame", "set"})},
         {"still", {{"type", "boolean"}, {"description", "Time stands at the first frame."}}},
         {"fps",
          {{"type", "number"},
           {"minimum", 0.1},
           {"maximum", 1000},
           {"description", "Frames a second; by default the scene's."}}}},
        "Frames run in order from an empty history; by default one.");
}

Json ablationsSchema() {
    Json stage = closed(
        {{"name", text("Of the stage: rows are called `<entry> without <name>`.")}, {"set", reference("values")}},
        "A stage, and the values that switch it off.", {"name", "set"});
    return listOf(
        closed({{"entry", text("An entry that is not swept.")}, {"stages", listOf(std::move(stage), "In turn.")}},
               "An entry without each of its stages.", {"entry", "stages"}),
        "What every stage of a method is worth: error and time without it.", 0);
}

Json figuresSchema() {
    Json box = listOf({{"type", "number"}, {"minimum", 0}, {"maximum", 1}},
                      "Left, top, width and height, as shares of the picture.", 4);
    box["maxItems"] = 4;
    Json crops = listOf(closed({{"name", text("Beside its row.")}, {"box", std::move(box)}}, "A crop.", {"box"}),
                        "What is enlarged.");
    crops["maxItems"] = 6;
    return listOf(
        closed({{"name", text("Of its files, figures/<name>.png and .svg.")},
                {"scene", text("A scene of the study; by default the first.")},
                {"frame", whole(0, 10'000'000, "A frame that is measured; by default the last.")},
                {"spp", whole(1, 65536, "A sample count; by default the least.")},
                {"input", text("The entry that stands first; by default the first whose module is none.")},
                {"entries", listOf(text("An entry's name."), "Which are shown; by default all.")},
                {"metric", oneOfNames(metricIds(false, true), "Of the maps and the numbers; by default flip.")},
                {"crops", std::move(crops)}},
               "An inset strip.", {"name", "crops"}),
        "Crops of a picture, as the input, the methods and the reference show them.", 0);
}

Json checksSchema() {
    Json bound = {{"type", "number"},
                  {"description", "Of the value, or of its ratio to each of those it is held against."}};
    return listOf(
        closed(
            {{"title", text("The claim in words.")},
             {"scene", text("A scene of the study; by default each.")},
             {"entry", text("An entry.")},
             {"metric", text("A metric or statistic of the study, or a time: frame_ms, run_ms, ns_per_ray, or with "
                             "\"tracing-stages\" tracing_ns_per_ray.")},
             {"against", listOf(text("An entry's name."), "Entries whose value times the bound is the limit.")},
             {"at-equal", text("A quantity like \"metric\": those it is held against are one curve, taken where this "
                               "is the entry's.")},
             {"at-most", bound},
             {"at-least", bound},
             {"on-average", {{"type", "boolean"}, {"description", "Over all scenes together, instead of on each."}}}},
            "A claim: at most or at least so much, or so many times another's value.", {"entry", "metric"}),
        "Claims that the numbers hold or not; a study whose claims fail ends with exit code 1.", 0);
}

Json statisticsSchema() {
    const Json number = {{"type", "number"}};
    Json limit = closed({{"percentile", {{"type", "number"}, {"minimum", 0}, {"maximum", 100}}},
                         {"share-below", number},
                         {"share-at-least", number}},
                        "One of them.");
    limit["minProperties"] = limit["maxProperties"] = 1;
    Json one = closed(
        {{"name", text("What results call it.")},
         {"title", text("What tables call it; by default its name.")},
         {"higher-is-better", {{"type", "boolean"}}},
         {"tap", text("A buffer of the entries' modules; entries without it have no value.")},
         {"channel", text("Of the buffer; by default its first.")},
         {"of",
          {{"description", "What of the buffer's pixels."},
           {"anyOf", {oneOfNames({"mean", "least", "most"}, "Over all."), std::move(limit)}}}},
         {"metric", oneOfNames(metricIds(false), "Against another reference.")},
         {"reference-spp", {{"type", "integer"}, {"minimum", 32}, {"maximum", 1 << 20}, {"multipleOf", 32}}},
         {"rays", oneOfNames({"camera", "bounce", "shadow", "all"}, "Rays a pixel that the method traced itself.")},
         {"memory", {{"description", "Bytes a pixel that the method holds."}, {"const", true}}},
         {"over", text("A statistic before this one, divided by")},
         {"under", text("another.")}},
        "A number of every measured frame.", {"name"});
    const auto needs = [](const char* kind, const char* other) {
        return Json{{"required", other ? Json{kind, other} : Json{kind}}};
    };
    one["oneOf"] = {needs("tap", "of"), needs("metric", "reference-spp"), needs("rays", nullptr),
                    needs("memory", nullptr), needs("over", "under")};
    return listOf(std::move(one), "Numbers beside the metrics: of buffers, of rays, of other references.", 0);
}

/// What a preset may change.
Json bodySchema() {
    Json all;
    Json size = listOf({{"type", "integer"}, {"minimum", 1}, {"maximum", 16384}},
                       "Width and height of the images; by default the scene's.", 2);
    size["maxItems"] = 2;
    all["size"] = size;
    all["scenes"] = listOf(sceneSchema(), "What is rendered.");
    all["frames"] = framesSchema();
    all["spp"] = wholes(1, 65536, "Samples a pixel and frame.");
    all["seeds"] = wholes(0, kReferenceSeed - 1, "Sets of random numbers; two or more give intervals.");
    all["set"] = reference("values");
    all["entries"] = listOf(entrySchema(), "The methods that are compared.");
    all["reference"] = closed({{"spp",
                                {{"type", "integer"},
                                 {"minimum", 32},
                                 {"maximum", 1 << 20},
                                 {"multipleOf", 32},
                                 {"description", "Samples a pixel, in two halves of independent random numbers."}}},
                               {"set", reference("values")}},
                              "What images are compared with.");
    all["metrics"] =
        listOf(oneOfNames(metricIds(true), "As `lumiscope list metrics` names them."), "What is measured.");
    all["statistics"] = statisticsSchema();
    all["tracing-stages"] = listOf(text("A stage of methods that trace their own rays."),
                                   "Where they trace them: the time a ray is told of these alone, too.");
    const Json stops = {{"type", "number"}, {"minimum", -100}, {"maximum", 100}};
    Json exposures = listOf(stops, "Start and stop in EV, and how many; by default what the reference says.", 2);
    exposures["prefixItems"] = {stops, stops, whole(2, 64, "How many exposures.")};
    exposures["maxItems"] = 3;
    all["metric-settings"] =
        closed({{"relmse-epsilon", {{"type", "number"}, {"minimum", 1e-12}, {"maximum", 1e6}, {"default", 0.001}}},
                {"hdr-flip-exposures", std::move(exposures)}},
               "What metrics are told beside the images.");
    Json along = reference("axes");
    along["description"] = "Parameters that change along with a single axis: a value for each of its.";
    all["sweep"] = closed({{"axes", reference("axes")},
                           {"with", std::move(along)},
                           {"entries", listOf(text("An entry's name."), "Which are swept; by default all.")}},
                          "Entries run with every combination of one or two parameters' values.", {"axes"});
    all["tuning"] = closed({{"frame", whole(0, 10'000'000, "A frame that is not measured.")},
                            {"metric", oneOfNames(metricIds(false), "What the best has best.")},
                            {"seed", whole(0, kReferenceSeed - 1, "Random numbers of the tuning frames.")}},
                           "How values under an entry's \"tune\" are chosen, for each scene: one parameter after the "
                           "other, from the middle of their values, until none moves.",
                           {"frame"});
    const Json others = {{"description",
                          "The entry it is held against, or several: the strongest of them counts. In a pair, or with "
                          "at-equal, they are one "
                          "method at several costs."},
                         {"anyOf", {text("An entry's name."), listOf(text("An entry's name."), "Entries.")}}};
    all["pairs"] = listOf(closed({{"entry", text("An entry.")}, {"against", others}}, "A pair.", {"entry", "against"}),
                          "Equal time, equal error and equivalent samples between entries.", 0);
    all["ablations"] = ablationsSchema();
    all["figures"] = figuresSchema();
    all["checks"] = checksSchema();
    all["intervals"] =
        closed({{"level", {{"type", "number"}, {"minimum", 0.5}, {"maximum", 0.9999}, {"default", 0.95}}},
                {"units", oneOfNames({"seeds", "frames-and-seeds"}, "What counts as an independent measurement.")},
                {"method", oneOfNames({"student-t", "bootstrap"}, "How intervals are found.")}},
               "How uncertainty is told.");
    all["pictures"] = closed({{"frames", wholes(0, 10'000'000, "Frames shown; by default the last that is measured.")},
                              {"spp", wholes(1, 65536, "Sample counts shown; by default the least and the most.")},
                              {"error-map", oneOfNames(metricIds(false, true), "Metric of the error maps.")}},
                             "Images of the report.");
    return all;
}

}  // namespace

std::string studyFileSchema() {
    Json top = {{"$schema", text("This schema.")},
                {"version", {{"const", 1}}},
                {"title", text("Shown in lists and reports.")},
                {"paper", text("Bibliography key of the paper whose figure it is.")},
                {"description", text("What the study asks.")}};
    const Json body = bodySchema();
    for (const auto& [key, value] : body.items()) top[key] = value;
    top["presets"] =
        mapOf(reference("preset"), "Sizes of the study by name: what stands here takes the study's place.");
    Json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", "Lumiscope study"}};
    schema.update(closed(std::move(top), "A study: scenes, methods, samples and metrics.", {"version"}));
    Json preset = closed(body, "Objects are merged member by member; everything else is replaced.");
    // A preset changes single members of objects, whose required ones stand in the study.
    for (const char* key : {"sweep", "tuning"}) preset["properties"][key].erase("required");
    schema["$defs"]["preset"] = std::move(preset);
    schema["$defs"]["values"] =
        mapOf({{"type", {"number", "boolean", "string", "array"}}}, "Parameter ids and their values.");
    schema["$defs"]["axes"] = mapOf(listOf({{"type", {"number", "boolean", "string", "array"}}}, "Values in turn."),
                                    "Parameter ids and the values they take.");
    return schema.dump(2) + "\n";
}

}  // namespace lumi
