#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "frame/display.h"
#include "image/exr.h"
#include "image/png.h"
#include "measure/map_range.h"
#include "study/report.h"

namespace lumi {
using Json = nlohmann::ordered_json;
namespace {

/// Beyond this a report shows no methods without a stage, and the ends of a sweep only: each picture is in the file.
constexpr size_t kMostMethods = 9;

std::string pngUri(const Image& image, const char* channels, const DisplaySettings& settings) {
    Image8 pixels;
    convert(image, channels, "none", settings, pixels);
    return "data:image/png;base64," + base64(encodePng(pixels));
}

Image readColour(const std::filesystem::path& path) { return readExr(path).image("", "RGB"); }

std::string hexColour(const Vec3& colour) {
    const auto byte = [](float v) { return static_cast<int>(std::lround(std::clamp(v, 0.0f, 1.0f) * 255)); };
    return fmt::format("#{:02x}{:02x}{:02x}", byte(colour.x), byte(colour.y), byte(colour.z));
}

/// The rows of one set of pictures: those of the first seed, a method each.
std::vector<const StudyRow*> rowsOf(const Study& study, const StudyPlan& plan, const StudyRecords& records,
                                    size_t scene, int64_t frame, int spp) {
    std::vector<const StudyRow*> rows;
    for (const StudyRow& row : records.rows)
        if (row.scene == scene && row.frame == frame && row.spp == spp && row.seed == study.seeds.front())
            rows.push_back(&row);
    std::sort(rows.begin(), rows.end(), [](const StudyRow* a, const StudyRow* b) { return a->method < b->method; });
    if (rows.size() > kMostMethods)
        std::erase_if(rows, [&](const StudyRow* row) { return plan.methods[row->method].whole.has_value(); });
    if (rows.size() > kMostMethods) rows.erase(rows.begin() + kMostMethods - 1, rows.end() - 1);
    return rows;
}

Json pictureSet(const Study& study, const StudyPlan& plan, const StudyRecords& records,
                const std::vector<const StudyRow*>& rows) {
    const StudyRow& first = *rows.front();
    float exposure = 0;
    for (const StudyReferenceNote& note : records.references)
        if (first.reference.filename() == std::filesystem::path(note.file).filename()) exposure = note.exposureEv;
    DisplaySettings colours;
    colours.exposureEv = exposure;
    colours.curve = ToneCurve::Clamp;
    const Metric& metric = findMetric(study.pictures.errorMap);

    const Image reference = readColour(first.reference);
    Json images = Json::array();
    std::vector<Image> maps;
    for (const StudyRow* row : rows) {
        ImagePair pair{readColour(row->image), readColour(row->reference), {}, exposure, study.metricSettings};
        images.push_back({{"name", plan.methods[row->method].name},
                          {"kind", "method"},
                          {"png", pngUri(pair.image, "RGB", colours)}});
        pair.prepare();
        maps.push_back(metric.measure(pair, true).map);
    }
    images.push_back({{"name", "Reference"}, {"kind", "reference"}, {"png", pngUri(reference, "RGB", colours)}});

    MapRange range(metric);
    for (const Image& map : maps) range.add(map);
    const DisplaySettings map = range.display();
    for (size_t i = 0; i < rows.size(); ++i) {
        const std::string& name = plan.methods[rows[i]->method].name;
        images.push_back({{"name", name + " error"},
                          {"title", name + " · " + metric.title},
                          {"kind", "error"},
                          {"of", name},
                          {"png", pngUri(maps[i], "Y", map)}});
    }
    Json bar = Json::array();
    for (int i = 0; i <= 8; ++i) bar.push_back(hexColour(colourMapValue(metric.mapColours, static_cast<float>(i) / 8)));
    return {
        {"scene", study.scenes[first.scene].name},
        {"frame", first.frame},
        {"spp", first.spp},
        {"width", reference.width()},
        {"height", reference.height()},
        {"images", std::move(images)},
        {"error_map", {{"title", metric.title}, {"low", map.low}, {"high", map.high}, {"colours", std::move(bar)}}}};
}

}  // namespace

std::string base64(const std::vector<uint8_t>& bytes) {
    static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (size_t i = 0; i < bytes.size(); i += 3) {
        const size_t left = std::min<size_t>(bytes.size() - i, 3);
        uint32_t group = uint32_t(bytes[i]) << 16;
        if (left > 1) group |= uint32_t(bytes[i + 1]) << 8;
        if (left > 2) group |= bytes[i + 2];
        for (size_t k = 0; k < 4; ++k) text += k <= left ? kDigits[(group >> (18 - 6 * k)) & 63] : '=';
    }
    return text;
}

Json reportPictures(const Study& study, const StudyPlan& plan, const StudyRecords& records) {
    std::vector<int64_t> frames = study.pictures.frames;
    if (frames.empty()) frames = {study.frames.measure.back()};
    std::vector<int> spp = study.pictures.spp;
    if (spp.empty()) {
        int low = 1 << 30, high = 0;
        for (const StudyRow& row : records.rows) low = std::min(low, row.spp), high = std::max(high, row.spp);
        spp = {low};
        if (high > low) spp.push_back(high);
    }
    Json sets = Json::array();
    for (size_t scene = 0; scene < study.scenes.size(); ++scene)
        for (const int64_t frame : frames)
            for (const int samples : spp)
                if (const auto rows = rowsOf(study, plan, records, scene, frame, samples); !rows.empty())
                    sets.push_back(pictureSet(study, plan, records, rows));
    return sets;
}

}  // namespace lumi
