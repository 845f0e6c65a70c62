#pragma once
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "study/figures.h"
#include "study/latex.h"
#include "study/records.h"

namespace lumi {

/// What a finished study says.
struct ReportContent {
    const nlohmann::ordered_json &results, &times;  ///< what results.json and timings.json hold
    const std::vector<DrawnFigure>& figures;
    const std::vector<LatexTable>& tables;
};

/// The report: one HTML file that needs nothing else, with tables, plots (SVG), inset strips, images and error maps
/// (PNG inside) that can be compared under a wipe, and the tables as LaTeX.
std::string studyReport(const Study& study, const StudyPlan& plan, const StudyRecords& records,
                        const ReportContent& content);

/// The pictures of a report, a set for each scene, frame and number of samples: {"scene", "frame", "spp", "width",
/// "height", "images": [{"name", "kind": "reference" | "method" | "error", "of": name, "png": data URI}],
/// "error_map": {"title", "low", "high", "colours"}}. Images are those of the first seed, as metrics see them.
nlohmann::ordered_json reportPictures(const Study& study, const StudyPlan& plan, const StudyRecords& records);

/// Text as it stands in HTML and XML.
std::string escapedMarkup(const std::string& text);
/// A page with values in the place of `open` name `close`; what is put in is not looked at again.
std::string filledTemplate(const std::string& page, const std::string& open, const std::string& close,
                           const std::map<std::string, std::string>& values);
std::string base64(const std::vector<uint8_t>& bytes);

}  // namespace lumi
