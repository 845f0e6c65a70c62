#include "study/figure_values.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "frame/display.h"
#include "image/exr.h"
#include "measure/map_range.h"
#include "study/run_job.h"

namespace lumi {
namespace {

Image readColour(const std::filesystem::path& path) { return readExr(path).image("", "RGB"); }

Image8 shown(const Image& image, const char* channels, const DisplaySettings& settings) {
    Image8 pixels;
    convert(image, channels, "none", settings, pixels);
    return pixels;
}

Image maskOf(const CropBox& box, Extent2 extent) {
    Image mask(extent, 1);
    for (int y = box.y; y < box.y + box.height; ++y)
        for (int x = box.x; x < box.x + box.width; ++x) mask.at(0, x, y) = 1;
    return mask;
}

/// Methods that the figure shows, the input first: of an entry that is swept the first point.
std::vector<size_t> methodsOf(const Study& study, const StudyPlan& plan, const StudyFigure& figure) {
    std::string input = figure.input;
    for (const StudyEntry& entry : study.entries)
        if (input.empty() && entry.module == "none" && figure.entries.empty()) input = entry.name;
    std::vector<size_t> methods;
    const auto add = [&](const std::string& name) {
        for (size_t i = 0; i < plan.methods.size(); ++i) {
            if (study.entries[plan.methods[i].entry].name != name || plan.methods[i].whole) continue;
            if (!std::count(methods.begin(), methods.end(), i)) methods.push_back(i);
            return;
        }
    };
    if (!input.empty()) add(input);
    for (const StudyEntry& entry : study.entries)
        if (figure.entries.empty()) add(entry.name);
    for (const std::string& name : figure.entries) add(name);
    return methods;
}

/// The entry's name, with the values of what is swept: their ids would not fit.
std::string titleOf(const Study& study, const StudyMethod& method) {
    std::string values;
    for (const std::string& value : method.coordinates) values += (values.empty() ? "" : ", ") + value;
    return study.entries[method.entry].name + (values.empty() ? "" : " [" + values + "]");
}

/// What the reference's own noise adds to the metric over the picture, where that can be taken off. It is known as a
/// mean over the picture only, not of its parts.
std::optional<double> floorOf(const StudyReferenceNote& note, const std::string& metric) {
    if (!isSquaredError(metric)) return std::nullopt;
    const auto found = note.floor.find(metric);
    return found == note.floor.end() ? std::nullopt : std::optional(found->second);
}

/// The value over the picture, less the reference's own error, and in each crop of one image; its map if asked for.
void measureImage(const Metric& metric, ImagePair pair, const std::vector<CropBox>& boxes, std::optional<double> floor,
                  FigureColumn& column, Image* map) {
    pair.prepare();
    Measurement whole = metric.measure(pair, map != nullptr);
    column.whole.push_back(floor ? withoutReferenceNoise(metric.id, whole.value, *floor) : whole.value);
    if (map) *map = std::move(whole.map);
    for (size_t i = 0; i < boxes.size(); ++i) {
        ImagePair part = pair;
        part.mask = maskOf(boxes[i], pair.image.extent());
        part.prepare();
        column.crops[i].push_back(metric.measure(part, false).value);
    }
}

}  // namespace

CropBox cropBox(const StudyFigure::Crop& crop, Extent2 extent) {
    const auto begin = [](double share, int size) {
        return std::min(static_cast<int>(std::lround(share * size)), size - 1);
    };
    CropBox box{begin(crop.x, extent.width), begin(crop.y, extent.height), 0, 0};
    box.width = std::clamp(static_cast<int>(std::lround(crop.width * extent.width)), 1, extent.width - box.x);
    box.height = std::clamp(static_cast<int>(std::lround(crop.height * extent.height)), 1, extent.height - box.y);
    return box;
}

Image8 cropped(const Image8& image, const CropBox& box) {
    Image8 part{{box.width, box.height}, {}};
    for (int y = box.y; y < box.y + box.height; ++y) {
        const auto row = image.rgba.begin() + 4 * (std::ptrdiff_t(y) * image.extent.width + box.x);
        part.rgba.insert(part.rgba.end(), row, row + 4 * box.width);
    }
    return part;
}

FigureContent figureContent(const Study& study, const StudyPlan& plan, const StudyRecords& records,
                            const StudyFigure& figure) {
    FigureContent content{figure.scene.empty() ? study.scenes.front().name : figure.scene,
                          figure.frame < 0 ? study.frames.measure.back() : figure.frame,
                          figure.spp,
                          {},
                          {},
                          {},
                          1};
    std::map<size_t, std::vector<const StudyRow*>> rows;  // by method
    for (const StudyRow& row : records.rows)
        if (content.spp == 0 || (figure.spp == 0 && row.spp < content.spp)) content.spp = row.spp;
    for (const StudyRow& row : records.rows)
        if (study.scenes[row.scene].name == content.scene && row.frame == content.frame && row.spp == content.spp)
            rows[row.method].push_back(&row);

    const Metric& metric = findMetric(figure.metric);
    DisplaySettings colours;
    colours.curve = ToneCurve::Clamp;
    std::vector<Image> errors;
    for (const size_t method : methodsOf(study, plan, figure)) {
        if (!rows.contains(method)) continue;
        const Image reference = readColour(rows[method].front()->reference);
        std::optional<double> floor;
        for (const StudyReferenceNote& note : records.references)
            if (rows[method].front()->reference.filename() == std::filesystem::path(note.file).filename())
                colours.exposureEv = note.exposureEv, floor = floorOf(note, figure.metric);
        if (isSquaredError(figure.metric))
            content.ownError = floor ? FigureContent::OwnError::TakenOff : FigureContent::OwnError::Left;
        if (content.columns.empty()) {
            content.reference = shown(reference, "RGB", colours);
            for (const StudyFigure::Crop& crop : figure.crops)
                content.boxes.push_back(cropBox(crop, reference.extent()));
        }
        FigureColumn column{titleOf(study, plan.methods[method]),
                            method,
                            {},
                            {},
                            {},
                            std::vector<std::vector<double>>(content.boxes.size())};
        for (const StudyRow* row : rows[method]) {
            const Image image = readColour(row->image);
            const bool first = row == rows[method].front();
            if (first) column.picture = shown(image, "RGB", colours), errors.emplace_back();
            measureImage(metric, {image, reference, {}, colours.exposureEv, study.metricSettings}, content.boxes, floor,
                         column, first ? &errors.back() : nullptr);
        }
        content.columns.push_back(std::move(column));
    }
    MapRange range(metric);
    for (const Image& map : errors) range.add(map);
    content.mapHigh = range.high();
    for (size_t i = 0; i < errors.size(); ++i) content.columns[i].map = shown(errors[i], "Y", range.display());
    return content;
}

}  // namespace lumi
