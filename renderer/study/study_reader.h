#pragma once
#include <string>
#include <vector>

#include "scene/json_reader.h"
#include "study/study.h"

// Parts of study_file.cpp that know the JSON but not the whole.
namespace lumi {

/// The text form of a value, as on the command line. Refuses null, objects and arrays of anything but three numbers.
std::string studyValueText(const JsonTree& tree, const JsonValue& value, const std::string& name);

/// Whole numbers of an array (or a single one) within limits, at least one. Refuses twins.
std::vector<int64_t> readWholes(const JsonTree& tree, const JsonValue& value, const std::string& name, int64_t min,
                                int64_t max);
std::vector<int> readInts(const JsonTree& tree, const JsonValue& value, const std::string& name, int min, int max);
/// Texts of an array, each once, at least one.
std::vector<std::string> readTexts(const JsonTree& tree, const JsonValue& value, const std::string& name);

/// {"id": value}.
std::vector<StudyValue> readValues(const JsonTree& tree, const JsonValue* section, const std::string& name);
/// {"id": [values]}; with `distinct` equal values are refused.
std::vector<StudyAxis> readAxes(const JsonTree& tree, const JsonValue* section, const std::string& name,
                                bool distinct = true);

/// Refuses names that are no good in results and file names.
void checkFileName(const JsonTree& tree, const JsonValue& value, const std::string& name);
/// The name of an entry that exists.
std::string readEntryName(const JsonTree& tree, const JsonValue& value, const Study& study, const std::string& name);

/// Of a study whose entries, sweep and frames are read.
void readAblations(const JsonTree& tree, const JsonValue* section, Study& study);
void readChecks(const JsonTree& tree, const JsonValue* section, Study& study);
void readFigures(const JsonTree& tree, const JsonValue* section, Study& study);

std::vector<StudyStatistic> readStatistics(const JsonTree& tree, const JsonValue* section);
/// Refuses taps that no entry's module has; of a study whose statistics and entries are read.
void checkStatisticTaps(const JsonTree& tree, const JsonValue* section, const Study& study);
/// {"statistic": number}, of a study whose statistics are read.
std::vector<std::pair<std::string, double>> readKnown(const JsonTree& tree, const JsonValue* section,
                                                      const Study& study);

MetricSettings readMetricSettings(const JsonTree& tree, const JsonValue* section);
StudyFrames readFrames(const JsonTree& tree, const JsonValue* section);
StudyIntervals readIntervals(const JsonTree& tree, const JsonValue* section);
StudyPictures readPictures(const JsonTree& tree, const JsonValue* section);

/// Throws Error(BadInput) headed by the value's place unless the module takes it. Ids with a dot that the module does
/// not declare are the document's, and are not checked.
void checkModuleValue(const std::string& module, const StudyValue& value);

/// `base` with the members of `over` in place of its own; objects are merged member by member.
JsonValue mergeJson(const JsonValue& base, const JsonValue& over);

}  // namespace lumi
