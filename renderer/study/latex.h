#pragma once
#include <string>
#include <vector>

#include "study/figures.h"
#include "study/times.h"

namespace lumi {

/// A table for a paper: a file of its own, made from one template (report/table.tex), for \input after
/// \usepackage{booktabs}.
struct LatexTable {
    std::string name;   ///< of its file, without extension
    std::string title;  ///< of the section in a report
    std::string text;
};

/// Results of each scene (and of all together), equal time and equal error of the pairs, what each stage is worth, and
/// the metrics' definitions. The best is bold only where the intervals tell it from all others. Times are of one
/// machine.
std::vector<LatexTable> latexTables(const Study& study, const StudyPlan& plan, const StudySummaries& summaries,
                                    const StudyTimes& times);

/// A document that has all of them in it, and the figures (report/document.tex).
std::string latexDocument(const Study& study, const std::vector<DrawnFigure>& figures,
                          const std::vector<LatexTable>& tables);

/// Text with every character that means something to LaTeX escaped.
std::string escapedLatex(const std::string& text);

}  // namespace lumi
