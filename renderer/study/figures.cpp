#include "study/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "frame/display.h"
#include "image/png.h"
#include "measure/measure.h"
#include "study/canvas.h"
#include "study/figure_values.h"
#include "study/number_text.h"

namespace lumi {
namespace {

// Sizes in units of the drawing; text is read when the whole is as wide as a page.
constexpr double kInset = 124, kGap = 5, kMargin = 8, kHeader = 38, kValue = 18, kRowGap = 9, kLine = 2.5;
constexpr double kTextSize = 12.5, kTitleSize = 13.5;
constexpr double kWidestPicture = 900, kPngScale = 2;
constexpr Colour8 kSoft{93, 97, 103};
/// Of the crops, told apart on any picture and by the colour-blind [Okabe & Ito 2008].
constexpr Colour8 kCropColours[] = {{230, 159, 0},   {0, 158, 115}, {86, 180, 233},
                                    {204, 121, 167}, {213, 94, 0},  {0, 114, 178}};

/// As much of a text as fits, by Inter's mean width of a letter.
std::string fitted(const std::string& text, double width, double size) {
    const size_t most = static_cast<size_t>(std::max(width / (0.56 * size), 4.0));
    return text.size() <= most ? text : text.substr(0, most - 1) + "…";
}

/// Intervals of the columns' values, and which of them is the best for sure.
struct Values {
    std::vector<Interval> intervals;
    std::vector<bool> best;
};

Values valuesOf(const Study& study, const std::vector<std::vector<double>>& values, bool higher) {
    Values result;
    const IntervalMethod method = intervalMethod(study);
    for (const std::vector<double>& own : values)
        result.intervals.push_back(meanInterval(own, study.intervals.level, method));
    const std::vector<Rank> ranks = rankMethods(values, higher, study.intervals.level, method);
    for (size_t i = 0; i < values.size(); ++i)
        result.best.push_back(values.size() > 1 && result.intervals[i].known() && ranks[i].certain() &&
                              ranks[i].best == 1);
    return result;
}

/// Where everything stands.
struct Layout {
    double pictureWidth = 0, pictureHeight = 0, left = 0, width = 0, height = 0;
    std::vector<double> rowTop, insetHeight;
};

Layout layOut(const FigureContent& content) {
    Layout layout;
    double y = kMargin + kHeader;
    for (const CropBox& box : content.boxes) {
        layout.rowTop.push_back(y);
        layout.insetHeight.push_back(kInset * box.height / box.width);
        y += 2 * layout.insetHeight.back() + kGap + kValue + kRowGap;
    }
    const double below = y - kRowGap - kValue + kGap, tall = below - kMargin - kHeader;
    const double aspect = double(content.reference.extent.width) / content.reference.extent.height;
    layout.pictureWidth = std::min(tall * aspect, kWidestPicture);
    layout.pictureHeight = layout.pictureWidth / aspect;
    layout.left = kMargin + layout.pictureWidth + 2 * kGap;
    layout.width = layout.left + double(content.columns.size() + 1) * (kInset + kGap) - kGap + kMargin;
    layout.height = y - kRowGap + kMargin;
    return layout;
}

void addPicture(const StudyFigure& figure, const Study& study, const FigureContent& content, const Layout& layout,
                Canvas& canvas) {
    const double top = kMargin + kHeader, sx = layout.pictureWidth / content.reference.extent.width;
    canvas.texts.push_back({kMargin, kMargin + 14, content.scene, kTitleSize, true});
    canvas.texts.push_back(
        {kMargin, kMargin + 30,
         fmt::format("frame {}, {} spp; shown: reference, {} spp", content.frame, content.spp, study.reference.spp),
         kTextSize, false, Canvas::Align::Left, kSoft});
    canvas.pictures.push_back({kMargin, top, layout.pictureWidth, layout.pictureHeight, content.reference});
    for (size_t i = 0; i < content.boxes.size(); ++i) {
        const CropBox& box = content.boxes[i];
        canvas.outlines.push_back({kMargin + box.x * sx - kLine, top + box.y * sx - kLine, box.width * sx + 2 * kLine,
                                   box.height * sx + 2 * kLine, kCropColours[i], kLine});
        if (!figure.crops[i].name.empty())
            canvas.texts.push_back({kMargin + box.x * sx - kLine, top + box.y * sx - kLine - 4, figure.crops[i].name,
                                    kTextSize, true, Canvas::Align::Left, kCropColours[i], true});
    }
}

void addColumn(const FigureContent& content, const FigureColumn& column, size_t index, const Layout& layout,
               const std::vector<Values>& values, Canvas& canvas) {
    const double x = layout.left + double(index) * (kInset + kGap), middle = x + kInset / 2;
    canvas.texts.push_back(
        {middle, kMargin + 14, fitted(column.title, kInset, kTitleSize), kTitleSize, true, Canvas::Align::Middle});
    const Values& whole = values.back();
    canvas.texts.push_back({middle, kMargin + 30, plainText(numberText(whole.intervals[index])), kTextSize,
                            whole.best[index], Canvas::Align::Middle, kSoft});
    for (size_t i = 0; i < content.boxes.size(); ++i) {
        const double top = layout.rowTop[i], height = layout.insetHeight[i];
        canvas.pictures.push_back({x, top, kInset, height, cropped(column.picture, content.boxes[i])});
        canvas.outlines.push_back({x, top, kInset, height, kCropColours[i], kLine});
        canvas.pictures.push_back({x, top + height + kGap, kInset, height, cropped(column.map, content.boxes[i])});
        canvas.texts.push_back({middle, top + 2 * height + kGap + 13.5,
                                plainText(numberText(values[i].intervals[index])), kTextSize, values[i].best[index],
                                Canvas::Align::Middle});
    }
}

/// The colours of the error map from 0 up, as a picture.
Image8 barOf(const Metric& metric) {
    constexpr int kSteps = 128;
    Image8 bar{{kSteps, 1}, {}};
    for (int i = 0; i < kSteps; ++i) {
        const Vec3 colour = colourMapValue(metric.mapColours, float(i) / (kSteps - 1));
        for (const float v : {colour.x, colour.y, colour.z})
            bar.rgba.push_back(static_cast<uint8_t>(std::lround(std::clamp(v, 0.0f, 1.0f) * 255)));
        bar.rgba.push_back(255);
    }
    return bar;
}

/// The last column: the crops of the reference, and under the first what the maps' colours mean.
void addReference(const FigureContent& content, const Layout& layout, const Metric& metric, Canvas& canvas) {
    const double x = layout.left + double(content.columns.size()) * (kInset + kGap), middle = x + kInset / 2;
    canvas.texts.push_back({middle, kMargin + 14, "Reference", kTitleSize, true, Canvas::Align::Middle});
    canvas.texts.push_back({middle, kMargin + 30, std::string(metric.title) + (metric.higherIsBetter ? " ↑" : " ↓"),
                            kTextSize, false, Canvas::Align::Middle, kSoft});
    for (size_t i = 0; i < content.boxes.size(); ++i) {
        canvas.pictures.push_back(
            {x, layout.rowTop[i], kInset, layout.insetHeight[i], cropped(content.reference, content.boxes[i])});
        canvas.outlines.push_back({x, layout.rowTop[i], kInset, layout.insetHeight[i], kCropColours[i], kLine});
    }
    const double top = layout.rowTop[0] + layout.insetHeight[0] + kGap;
    canvas.texts.push_back({x, top + 12, metric.title, kTextSize, false, Canvas::Align::Left, kSoft});
    canvas.pictures.push_back({x, top + 18, kInset, 8, barOf(metric)});
    canvas.texts.push_back({x, top + 40, "0", kTextSize, false, Canvas::Align::Left, kSoft});
    canvas.texts.push_back(
        {x + kInset, top + 40, fmt::format("{:.3g}", content.mapHigh), kTextSize, false, Canvas::Align::Right, kSoft});
}

std::string captionOf(const Study& study, const StudyFigure& figure, const FigureContent& content,
                      const Metric& metric) {
    std::string text =
        fmt::format("{}, frame {}, {} spp: the reference ({} spp) with its crops, and each crop above its map of {}.",
                    content.scene, content.frame, content.spp, study.reference.spp, metric.title);
    text += fmt::format(" Numbers are {} within the crop, those in the head over the whole picture", metric.title);
    if (content.ownError == FigureContent::OwnError::TakenOff)
        text += ", without the reference's own error, which stays in those of the crops";
    if (content.ownError == FigureContent::OwnError::Left) text += ", all with the reference's own error in them";
    if (study.seeds.size() < 2) return text + "; one seed, so nothing is known of their noise.";
    return text +
           fmt::format(
               ": means over {} seeds with the half-width of the {:g}% interval, pictures are those of seed {}. The "
               "best is bold "
               "where the intervals tell it from all others.",
               study.seeds.size(), 100 * study.intervals.level, study.seeds.front()) +
           (figure.crops.size() > 1 ? " Colours mark the crops." : "");
}

}  // namespace

std::vector<DrawnFigure> drawFigures(const Study& study, const StudyPlan& plan, const StudyRecords& records,
                                     MessageLog& log) {
    std::vector<DrawnFigure> figures;
    for (const StudyFigure& figure : study.figures) {
        const FigureContent content = figureContent(study, plan, records, figure);
        if (content.columns.empty()) {
            log.warning(fmt::format("figure \"{}\" is left out: the study has no images of {}, frame {}, {} spp",
                                    figure.name, content.scene, content.frame, content.spp));
            continue;
        }
        const Metric& metric = findMetric(figure.metric);
        std::vector<Values> values;  // of each crop, then of the whole picture
        for (size_t i = 0; i <= content.boxes.size(); ++i) {
            std::vector<std::vector<double>> columns;
            for (const FigureColumn& column : content.columns)
                columns.push_back(i < content.boxes.size() ? column.crops[i] : column.whole);
            values.push_back(valuesOf(study, columns, metric.higherIsBetter));
        }
        const Layout layout = layOut(content);
        DrawnFigure drawn{fileNameOf(figure.name), captionOf(study, figure, content, metric), layout.width, {}, {}};
        Canvas canvas;
        canvas.width = layout.width, canvas.height = layout.height, canvas.title = drawn.caption;
        addPicture(figure, study, content, layout, canvas);
        for (size_t i = 0; i < content.columns.size(); ++i)
            addColumn(content, content.columns[i], i, layout, values, canvas);
        addReference(content, layout, metric, canvas);
        drawn.svg = svgOf(canvas);
        drawn.png = encodePng(rasterOf(canvas, kPngScale, log));
        figures.push_back(std::move(drawn));
    }
    return figures;
}

}  // namespace lumi
