#pragma once
#include <functional>
#include <string>
#include <vector>

#include "study/study.h"

namespace lumi {

/// An index into the values of each axis.
using TuningPlace = std::vector<size_t>;

struct TuningSearch {
    std::vector<TuningPlace> places;  ///< in the order in which they were measured
    std::vector<double> values;       ///< of each
    size_t best = 0;                  ///< index of the one that is chosen; `places.size()` if none has a value
};

/// Looks for the place with the best value on the grid of the axes, which have `counts` values: from the middle of
/// each, one axis after the other takes all its values while the others stay, and keeps the best, until a round over
/// all axes moves none; after the first round only gains of a thousandth move. One axis: every value is tried. Of
/// equals the first is kept, so that the choice never depends on chance; what is NaN is never chosen. `measure` gives a
/// value for each of the places, none of which it was asked about before.
TuningSearch searchTuning(const std::vector<size_t>& counts, bool higherIsBetter,
                          const std::function<std::vector<double>(const std::vector<TuningPlace>&)>& measure);

/// About how often searchTuning() measures, and how many places in all; for estimates of time alone.
struct TuningEffort {
    size_t runs = 0, places = 0;
};
TuningEffort tuningEffort(const std::vector<StudyAxis>& axes);

/// The values at a place, an axis each.
std::vector<StudyValue> tuningValues(const std::vector<StudyAxis>& axes, const TuningPlace& place);

/// Ids of those axes of three numbers or more on which `values` has the least or the greatest: the best may lie beyond
/// it.
std::vector<std::string> tunedToAnEnd(const std::vector<StudyAxis>& axes,
                                      const std::vector<std::pair<std::string, std::string>>& values);

}  // namespace lumi
