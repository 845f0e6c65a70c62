#include "study/tuning.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace lumi {
namespace {

std::optional<double> numberOf(const std::string& text) {
    size_t used = 0;
    try {
        const double number = std::stod(text, &used);
        return used == text.size() ? std::optional(number) : std::nullopt;
    } catch (const std::exception&) {
        return std::nullopt;
    }
}

/// Part of the value that a later round has to gain to move: parameters that hardly matter would lead through the whole
/// grid.
constexpr double kLeastGain = 0.001;

/// The values of every place that was measured.
class Measured {
public:
    Measured(TuningSearch& search, const std::function<std::vector<double>(const std::vector<TuningPlace>&)>& measure)
        : search_(search), measure_(measure) {}

    /// Measures those of the places that are new.
    void require(const std::vector<TuningPlace>& places) {
        std::vector<TuningPlace> fresh;
        for (const TuningPlace& place : places)
            if (!index_.count(place)) index_[place] = search_.places.size() + fresh.size(), fresh.push_back(place);
        if (fresh.empty()) return;
        const std::vector<double> values = measure_(fresh);
        search_.places.insert(search_.places.end(), fresh.begin(), fresh.end());
        search_.values.insert(search_.values.end(), values.begin(), values.end());
    }
    size_t indexOf(const TuningPlace& place) const { return index_.at(place); }

private:
    TuningSearch& search_;
    const std::function<std::vector<double>(const std::vector<TuningPlace>&)>& measure_;
    std::map<TuningPlace, size_t> index_;
};

}  // namespace

TuningSearch searchTuning(const std::vector<size_t>& counts, bool higherIsBetter,
                          const std::function<std::vector<double>(const std::vector<TuningPlace>&)>& measure) {
    TuningSearch search;
    Measured measured(search, measure);
    TuningPlace at;
    for (const size_t count : counts) at.push_back(count / 2);
    double gain = 0;  // in the first round any counts
    for (bool moved = true; moved; gain = kLeastGain) {
        moved = false;
        for (size_t axis = 0; axis < counts.size(); ++axis) {
            std::vector<TuningPlace> line(counts[axis], at);
            for (size_t i = 0; i < counts[axis]; ++i) line[i][axis] = i;
            measured.require(line);
            const auto valueOf = [&](const TuningPlace& place) { return search.values[measured.indexOf(place)]; };
            const TuningPlace* best = nullptr;
            for (const TuningPlace& place : line) {
                const double value = valueOf(place);
                if (std::isnan(value)) continue;
                if (!best || (higherIsBetter ? value > valueOf(*best) : value < valueOf(*best))) best = &place;
            }
            if (!best || *best == at) continue;
            if (std::abs(valueOf(*best) - valueOf(at)) < gain * std::abs(valueOf(at))) continue;
            at = *best;
            moved = true;
        }
    }
    const size_t last = measured.indexOf(at);
    search.best = std::isnan(search.values[last]) ? search.places.size() : last;
    return search;
}

TuningEffort tuningEffort(const std::vector<StudyAxis>& axes) {
    TuningEffort effort;
    for (const StudyAxis& axis : axes) effort.places += axis.values.size();
    if (axes.size() <= 1) return {1, effort.places};
    return {2 * axes.size(), 2 * effort.places};
}

std::vector<StudyValue> tuningValues(const std::vector<StudyAxis>& axes, const TuningPlace& place) {
    std::vector<StudyValue> values;
    for (size_t i = 0; i < axes.size(); ++i) values.push_back({axes[i].id, axes[i].values[place[i]], axes[i].where});
    return values;
}

std::vector<std::string> tunedToAnEnd(const std::vector<StudyAxis>& axes,
                                      const std::vector<std::pair<std::string, std::string>>& values) {
    std::vector<std::string> ids;
    for (const StudyAxis& axis : axes) {
        const auto chosen =
            std::find_if(values.begin(), values.end(), [&](const auto& value) { return value.first == axis.id; });
        std::vector<double> numbers;
        for (const std::string& text : axis.values)
            if (const auto number = numberOf(text)) numbers.push_back(*number);
        if (chosen == values.end() || numbers.size() < 3 || numbers.size() != axis.values.size()) continue;
        const double own = *numberOf(chosen->second);
        const auto [least, most] = std::minmax_element(numbers.begin(), numbers.end());
        if (own == *least || own == *most) ids.push_back(axis.id);
    }
    return ids;
}

}  // namespace lumi
