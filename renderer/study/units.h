#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "study/intervals.h"
#include "study/records.h"

namespace lumi {

/// Index of "all scenes together" in summaries.
inline constexpr size_t kAllScenes = static_cast<size_t>(-1);

/// Rows by method and number of samples.
class StudyRowIndex {
public:
    explicit StudyRowIndex(const StudyRecords& records);
    const std::vector<const StudyRow*>& of(size_t method, int spp) const;
    const std::vector<int>& spp() const { return spp_; }           ///< ascending
    const std::vector<size_t>& scenes() const { return scenes_; }  ///< kAllScenes last, where there are several

private:
    std::map<std::pair<size_t, int>, std::vector<const StudyRow*>> rows_;
    std::vector<int> spp_;
    std::vector<size_t> scenes_;
};

/// The corrected values of a metric, where there are some, or those as measured.
enum class ValueKind { Corrected, Measured };

/// Values of a metric by unit: a seed, or a frame and seed. The units are the study's, in one order for all methods, so
/// that values of two methods at one place belong together. NaN where any image of the unit has no value: a mean over
/// what is left would be of something else. Empty if the method was not measured so. `frame` -1: all.
std::vector<double> unitValues(const Study& study, const StudyRowIndex& rows, size_t scene, size_t method, int spp,
                               const std::string& metric, int64_t frame = -1, ValueKind kind = ValueKind::Corrected);

/// Units without a value.
int64_t countMissing(const std::vector<double>& values);
double finiteMean(const std::vector<double>& values);

/// Images' metrics, those of sequences, and the statistics.
std::vector<std::string> allMetrics(const Study& study);
/// A metric's definition, with what the study tells it.
std::string definitionOf(const Study& study, const std::string& metric);
/// Of a metric, a statistic or a time quantity.
std::string titleOf(const Study& study, const std::string& metric);
bool higherIsBetter(const Study& study, const std::string& metric);
IntervalMethod intervalMethod(const Study& study);

}  // namespace lumi
