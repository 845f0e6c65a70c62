#pragma once
#include <vector>

#include "image/image.h"
#include "study/summary.h"

namespace lumi {

/// Pixels of a crop.
struct CropBox {
    int x = 0, y = 0, width = 0, height = 0;
};
/// At least one pixel, within the extent.
CropBox cropBox(const StudyFigure::Crop& crop, Extent2 extent);
Image8 cropped(const Image8& image, const CropBox& box);

/// A column of a figure: one method's images of all seeds against the reference.
struct FigureColumn {
    std::string title;
    size_t method = 0;
    Image8 picture, map;                     ///< of the first seed, whole
    std::vector<double> whole;               ///< the metric over the picture, a seed each; see FigureContent::ownError
    std::vector<std::vector<double>> crops;  ///< within each crop, a seed each, as measured
};

struct FigureContent {
    std::string scene;
    int64_t frame = 0;
    int spp = 1;
    Image8 reference;
    std::vector<CropBox> boxes;
    std::vector<FigureColumn> columns;  ///< the input first
    float mapHigh = 1;                  ///< of the colour bar, which begins at 0
    /// What became of the reference's own error in the values over the picture. Apart: no part of the metric that could
    /// be told.
    enum class OwnError { Apart, TakenOff, Left } ownError = OwnError::Apart;
};

/// What a figure shows; no columns if the study has no such images (a scene that was left out).
FigureContent figureContent(const Study& study, const StudyPlan& plan, const StudyRecords& records,
                            const StudyFigure& figure);

}  // namespace lumi
