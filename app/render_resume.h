#pragma once
#include <functional>

#include "app/render_command.h"

namespace lumi {

/// Which frames of a series have still to be drawn.
struct ResumePlan {
    int64_t from = 0;   ///< the first frame to run, with empty history; equal to the range's end if all are there
    int64_t write = 0;  ///< the first frame to write; those before it run for the sake of history alone
    int64_t kept = 0;   ///< frames that are there already
};

/// Looks at the numbered files that are there, from `begin` on. A frame is there if all its files are whole and hold
/// the state that it will have, as `documentAt` gives its values; the history of the next one then begins where that
/// state says. `first` is the first frame of the run, before `begin` where it warms up. Throws Error(Usage) naming a
/// file that is there and holds something else.
ResumePlan planResume(const RenderOutputs& outputs, const SceneReference& scene, const OutputChoice& choice,
                      const std::function<Document(int64_t)>& documentAt, int64_t first, int64_t begin, int64_t end);

}  // namespace lumi
