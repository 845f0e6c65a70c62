#include "app/render_resume.h"

#include <memory>
#include <utility>

#include "base/error.h"

namespace lumi {
namespace {

/// The text that the state of a frame has when its history began at frame `start`.
class ExpectedStates {
public:
    ExpectedStates(const SceneReference& scene, const OutputChoice& choice,
                   const std::function<Document(int64_t)>& documentAt)
        : scene_(scene), output_(choice.json()), documentAt_(documentAt) {}

    std::string of(int64_t start, int64_t frame) {
        if (start != start_ || frame < next_) {
            log_ = StateLog(scene_);
            start_ = next_ = start;
        }
        for (; next_ <= frame; ++next_) {
            FrameOutput output;
            output.number = next_;
            output.changes.cut = next_ == start_;
            log_.record(output, std::make_shared<Document>(documentAt_(next_)));
        }
        return log_.json(output_);
    }

private:
    const SceneReference scene_;
    const nlohmann::json output_;
    const std::function<Document(int64_t)>& documentAt_;
    StateLog log_;
    int64_t start_ = -1, next_ = -1;
};

}  // namespace

ResumePlan planResume(const RenderOutputs& outputs, const SceneReference& scene, const OutputChoice& choice,
                      const std::function<Document(int64_t)>& documentAt, int64_t first, int64_t begin, int64_t end) {
    ResumePlan plan{first, begin, 0};
    ExpectedStates expected(scene, choice, documentAt);
    int64_t start = first, frame = begin;
    for (; frame < end; ++frame) {
        const std::vector<std::string> names = outputs.numberedFiles(frame);
        if (names.empty() || !outputs.allThere(names)) break;
        for (const std::string& name : names) {
            const std::string text = stateTextOf(name);
            start = parseReplay(text, name).first;
            if (start < first || start > frame || text != expected.of(start, frame))
                RenderOutputs::throwOtherState(name);
        }
    }
    plan.kept = frame - begin;
    if (frame == end && !outputs.hasLastFrameFiles()) return {end, end, plan.kept};
    if (frame == begin) return plan;
    plan.write = std::min(frame, end - 1);
    plan.from = start;
    return plan;
}

}  // namespace lumi
