#pragma once
#include <optional>
#include <string>
#include <vector>

#include "study/study.h"

namespace lumi {

/// One row of the tables: an entry, at one point of the sweep, or without one of its stages.
struct StudyMethod {
    size_t entry = 0;                      ///< index into Study::entries
    std::string name;                      ///< the entry's, with what is swept: `svgf [sigma-l=4]`
    std::string instance;                  ///< name in the frame engine: `svgf@m3`
    std::vector<std::string> coordinates;  ///< values on the sweep's axes; empty: not swept
    std::vector<StudyValue> set;           ///< the entry's values, then the sweep's or those that switch a stage off
    std::vector<std::string> fixed;  ///< ids that tuning may not set: the sweep's, and those that switch a stage off
    std::optional<size_t> whole;     ///< of a stage switched off: the method that has it
    std::string stage;               ///< its name
};

/// What is run at once, and is done again as a whole when it was interrupted: one scene, sample count and seed, and all
/// methods that can share its samples.
struct StudyJob {
    enum class Kind { Tune, Measure };
    Kind kind = Kind::Measure;
    std::string id;  ///< readable and unique in the study, as `atrium-spp1-seed2-a`; a folder's name
    size_t scene = 0;
    int spp = 1, seed = 0;
    std::vector<size_t> methods;       ///< Measure: indices into StudyPlan::methods
    size_t entry = 0;                  ///< Tune: index into Study::entries
    std::vector<StudyValue> sampling;  ///< document values that all methods of the job share
    std::string definition;            ///< everything in the study that the result depends on, as text
};

/// A study as a list of jobs, in an order that never changes: tuning before what it tunes, scene by scene, and in each
/// by samples, seeds and groups of methods.
struct StudyPlan {
    std::vector<StudyMethod> methods;
    std::vector<StudyJob> jobs;
};

StudyPlan planStudy(const Study& study);

/// All combinations of the axes' values; the last axis changes fastest.
std::vector<std::vector<StudyValue>> combinations(const std::vector<StudyAxis>& axes);

/// Is the id one of the document's rather than of the module?
bool isDocumentId(const std::string& module, const std::string& id);

/// Does the method lack a stage whose values are the document's (`path.max-depth`, `camera.jitter`)? Then its frames
/// are traced apart from those of the whole method, and the two do not share their samples.
bool tracesApart(const Study& study, const StudyMethod& method);

/// Letters, digits, - and . kept, everything else becomes -.
std::string fileNameOf(const std::string& name);

/// The last frame that a job runs.
int64_t lastFrame(const Study& study, StudyJob::Kind kind);

}  // namespace lumi
