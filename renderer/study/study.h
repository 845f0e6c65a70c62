#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "math/vector.h"
#include "measure/measure.h"

namespace lumi {

/// A parameter's id and its value in the form of the command line, with the place in the study file it came from.
struct StudyValue {
    std::string id, text;
    std::string where;
};

/// Values that one parameter takes in turn: a sweep's axis, or what tuning chooses from.
struct StudyAxis {
    std::string id;  ///< of the entries' module (`sigma-l`), or of the document (`path.max-depth`)
    std::vector<std::string> values;
    std::string where;
};

struct StudyScene {
    std::string name;       ///< in results; unique in a study
    std::string source;     ///< a built-in name, a path (relative to the study file too), or `assets:` and a path there
    bool optional = false;  ///< left out, with a warning, where it is not found
    std::vector<StudyValue> set;
    std::string where;
};

/// One method: a module with parameters, or the same module on other samples.
struct StudyEntry {
    std::string name;    ///< in results; unique in a study
    std::string module;  ///< id of the catalogue
    std::vector<StudyValue> set;
    std::vector<StudyAxis> tune;                        ///< chosen for each scene; see StudyTuning
    std::vector<int> spp;                               ///< instead of the study's; empty: those
    std::vector<std::pair<std::string, double>> known;  ///< statistics that are so by construction, by name
};

/// From one frame on the document has other values: a lamp is switched on, a wall is painted.
struct StudyStep {
    int64_t frame = 0;            ///< the first that has them
    std::vector<StudyValue> set;  ///< each defines the image
};

/// Frames [begin, end) run in order from an empty history; some are measured.
struct StudyFrames {
    int64_t begin = 0, end = 1;
    std::vector<int64_t> measure{0};             ///< ascending, within the range
    int64_t temporalBegin = 0, temporalEnd = 0;  ///< frames whose difference to the one before is measured
    int64_t temporalMeanFrom = 0;                ///< of these, the first that counts for their mean
    bool still = false;                          ///< time stands at the first frame
    float fps = 0;                               ///< 0: the scene's
    std::optional<StudyStep> step;
};

struct StudyReference {
    int spp = 1024;               ///< in two halves of independent random numbers
    std::vector<StudyValue> set;  ///< on top of the study's values that define the image
};

struct StudySweep {
    std::vector<StudyAxis> axes;       ///< one or two
    std::vector<StudyAxis> with;       ///< what moves along with a single axis, a value for each of its
    std::vector<std::string> entries;  ///< swept; empty: all
};

/// How parameters under "tune" are chosen: by the best metric on one frame that is not measured, one parameter after
/// the other until none moves (study/tuning.h).
struct StudyTuning {
    int64_t frame = 0;
    std::string metric = "rmse";
    int seed = 0;
};

/// "What would `against` reach in the time of `entry`, and how long would it take to reach its error?"
struct StudyPair {
    std::string entry;
    std::vector<std::string> against;  ///< several are one method at several costs
};

/// A number of every measured frame beside the metrics. Which of its parts are there says what it is of: a buffer of
/// the method, a metric against another reference, the rays that the method traced itself, the bytes that it holds, or
/// the ratio of two others.
struct StudyStatistic {
    enum class Of { Mean, Least, Most, Percentile, ShareBelow, ShareAtLeast };
    std::string name, title, definition;
    bool higherIsBetter = false;
    std::string tap;
    std::string channel;  ///< of the tap; empty: its first
    Of of = Of::Mean;     ///< over the tap's pixels that are finite
    double value = 0;     ///< of Percentile, ShareBelow and ShareAtLeast
    std::string metric;   ///< of the catalogue, against a reference of `referenceSpp`
    int referenceSpp = 0;
    std::string rays;         ///< camera, bounce, shadow or all: a pixel
    bool memory = false;      ///< bytes a pixel
    std::string over, under;  ///< statistics before this one: `over` divided by `under`
};

/// Each stage of an entry switched off in turn.
struct StudyAblation {
    std::string entry;
    struct Stage {
        std::string name;
        std::vector<StudyValue> set;  ///< what switches it off, on top of the entry's values
    };
    std::vector<Stage> stages;
};

/// A claim that the numbers hold or not, on each scene or on average.
struct StudyCheck {
    std::string title;  ///< in words; empty: made from the rest
    std::string scene;  ///< where it is claimed; empty: on each
    std::string entry, metric;
    std::vector<std::string> against;  ///< entries whose value times `bound` is the limit; empty: `bound` is
    std::string atEqual;               ///< not empty: those are one curve, taken where this quantity is the entry's
    double bound = 1;
    bool atLeast = false;  ///< else at most
    bool onAverage = false;

    /// Is it about times, which differ from run to run?
    bool timed() const;
};

/// Quantities of a check beside metrics and statistics: `frame_ms`, `run_ms`, `ns_per_ray` and, in studies that name
/// the stages that trace, `tracing_ns_per_ray`.
const std::vector<std::string>& timeQuantities();
bool isTimeQuantity(const std::string& id);

/// An inset strip: one picture with its crops marked, and each crop as the methods show it.
struct StudyFigure {
    std::string name;    ///< of its files
    std::string scene;   ///< empty: the study's first that is there
    int64_t frame = -1;  ///< one that is measured; -1: the last
    int spp = 0;         ///< 0: the least of the study
    std::string input;   ///< entry that is shown first, as the input; empty: the first whose module is none
    std::vector<std::string> entries;  ///< empty: all
    std::string metric = "flip";       ///< of the maps, and the value under each crop
    struct Crop {
        std::string name;
        double x = 0, y = 0, width = 0, height = 0;  ///< shares of the picture, from its top left
    };
    std::vector<Crop> crops;
};

/// How the uncertainty of a number is found.
struct StudyIntervals {
    enum class Units { Seeds, FramesAndSeeds };
    enum class Method { StudentT, Bootstrap };
    double level = 0.95;
    Units units = Units::Seeds;
    Method method = Method::StudentT;
};

/// Which images the report shows.
struct StudyPictures {
    std::vector<int64_t> frames;  ///< empty: the last that is measured
    std::vector<int> spp;         ///< empty: the first and the last
    std::string errorMap = "flip";
};

/// A study file with one preset applied.
struct Study {
    std::filesystem::path path;
    std::string name;    ///< the file's, without folder and extension
    std::string digest;  ///< of the file's bytes
    std::string preset;
    std::string title, paper, description;
    std::vector<StudyScene> scenes;
    std::vector<StudyEntry> entries;
    std::vector<StudyValue> set;  ///< of the document, for every entry and reference
    Extent2 size{0, 0};           ///< 0: the scene's
    StudyFrames frames;
    std::vector<int> spp{1}, seeds{1};
    StudyReference reference;
    std::vector<std::string> metrics;          ///< of images, as `list metrics` names them
    std::vector<std::string> temporalMetrics;  ///< of sequences
    std::vector<StudyStatistic> statistics;
    std::vector<std::string>
        tracingStages;              ///< of methods, where they trace their own rays: what `tracing_ns_per_ray` counts
    MetricSettings metricSettings;  ///< for every metric, reference and figure
    std::optional<StudySweep> sweep;
    std::optional<StudyTuning> tuning;
    std::vector<StudyPair> pairs;
    std::vector<StudyAblation> ablations;
    std::vector<StudyFigure> figures;
    std::vector<StudyCheck> checks;
    StudyIntervals intervals;
    StudyPictures pictures;

    const StudyEntry* entry(const std::string& name) const;
    const StudyStatistic* statistic(const std::string& name) const;
    /// A metric or a statistic.
    bool measures(const std::string& metric) const;
};

/// Seeds of a reference's two halves; a study's own seeds are below.
inline constexpr int kReferenceSeed = 900'000'001;

}  // namespace lumi
