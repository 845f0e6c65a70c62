#include "study/tuning.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

namespace lumi::test {
namespace {

using Places = std::vector<TuningPlace>;

TEST(Tuning, OneAxisIsTriedWhole) {
    int runs = 0;
    const TuningSearch search = searchTuning({5}, false, [&](const Places& places) {
        ++runs;
        std::vector<double> values;
        for (const TuningPlace& place : places) values.push_back(std::abs(static_cast<double>(place[0]) - 3.2));
        return values;
    });
    EXPECT_EQ(runs, 1);
    EXPECT_EQ(search.places, (Places{{0}, {1}, {2}, {3}, {4}}));
    EXPECT_EQ(search.places[search.best], TuningPlace{3});
}

/// A tilted valley: each axis has to be moved more than once.
TEST(Tuning, AxesMoveInTurnUntilNoneDoes) {
    std::set<TuningPlace> asked;
    const auto value = [](const TuningPlace& at) {
        const double x = static_cast<double>(at[0]) - 6, y = static_cast<double>(at[1]) - 1;
        return x * x + y * y + 0.5 * x * y;
    };
    const TuningSearch search = searchTuning({9, 9}, false, [&](const Places& places) {
        std::vector<double> values;
        for (const TuningPlace& place : places) {
            EXPECT_TRUE(asked.insert(place).second) << "asked about twice";
            values.push_back(value(place));
        }
        return values;
    });
    EXPECT_EQ(search.places[search.best], (TuningPlace{6, 1}));
    EXPECT_EQ(search.places.size(), asked.size());
    EXPECT_LT(asked.size(), 81u);
}

TEST(Tuning, HigherMayBeBetterEqualsKeepTheFirstAndNanIsNeverChosen) {
    const auto best = [](bool higher, std::vector<double> values) {
        const TuningSearch search = searchTuning({values.size()}, higher, [&](const Places&) { return values; });
        return search.best;
    };
    EXPECT_EQ(best(true, {1, 4, 2}), 1u);
    EXPECT_EQ(best(false, {3, 2, 2}), 1u);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(best(false, {nan, nan, 7}), 2u);
    EXPECT_EQ(best(false, {nan, nan, nan}), 3u) << "none has a value";
}

TEST(Tuning, AChoiceAtAnEndIsTold) {
    const std::vector<StudyAxis> axes{{"sigma", {"0.5", "2", "8", "32"}, ""},
                                      {"turned", {"3", "1", "2"}, ""},
                                      {"two", {"1", "2"}, ""},
                                      {"kind", {"a", "b", "c"}, ""}};
    const auto ends = [&](const char* sigma, const char* turned) {
        return tunedToAnEnd(axes, {{"sigma", sigma}, {"turned", turned}, {"two", "1"}, {"kind", "a"}});
    };
    EXPECT_EQ(ends("32", "2"), std::vector<std::string>{"sigma"});
    EXPECT_EQ(ends("8", "1"), std::vector<std::string>{"turned"});
    EXPECT_TRUE(ends("2", "2").empty());
}

}  // namespace
}  // namespace lumi::test
