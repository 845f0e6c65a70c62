#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "base/messages.h"
#include "study/summary.h"

namespace lumi {

/// An inset strip of a finished study, drawn: the reference with its crops marked, and each crop as the input, the
/// methods and the reference show it, above its error map and the metric's value in it.
struct DrawnFigure {
    std::string name;     ///< of its files, without extension
    std::string caption;  ///< what it shows, in words
    double width = 0;     ///< in units of the drawing
    std::vector<uint8_t> png;
    std::string svg;
};

/// The figures of the study, in its order; those of scenes that were left out are left out too. Pictures are those of
/// the first seed; values are means over the seeds, the best in bold only where their intervals tell it from all
/// others.
std::vector<DrawnFigure> drawFigures(const Study& study, const StudyPlan& plan, const StudyRecords& records,
                                     MessageLog& log);

}  // namespace lumi
