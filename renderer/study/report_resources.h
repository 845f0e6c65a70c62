#pragma once

namespace lumi {

/// The files of renderer/study/report/, part of the program so that it needs nothing beside it.
extern const char* const kReportHtml;
extern const char* const kReportCss;
extern const char* const kChartsJs;
extern const char* const kViewerJs;
extern const char* const kReportJs;
extern const char* const kReportTimesJs;
extern const char* const kReportPageJs;
extern const char* const kTableTex;
extern const char* const kDocumentTex;

}  // namespace lumi
