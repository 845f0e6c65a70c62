#pragma once
#include <optional>
#include <string>
#include <vector>

#include "session/document.h"

namespace lumi {

/// Undo and redo over documents. Edits of the same ids in a row are one step until end() is called.
class EditHistory {
public:
    /// Before an edit: `before` is the document as it is, `ids` what is about to change.
    void begin(const Document& before, const std::string& ids) {
        redo_.clear();
        if (open_ && ids == ids_) return;
        if (undo_.size() >= kSteps) undo_.erase(undo_.begin());
        undo_.push_back({before, ids});
        ids_ = ids;
        open_ = true;
    }
    void end() { open_ = false; }
    void clear() { *this = {}; }

    /// The document before the last step, or nothing; `present` is what redo() gives back. Time stays, unless the step
    /// was an edit of it: an animation that plays goes on.
    std::optional<Document> undo(const Document& present) {
        open_ = false;
        return move(undo_, redo_, present);
    }
    std::optional<Document> redo(const Document& present) {
        open_ = false;
        return move(redo_, undo_, present);
    }

private:
    static constexpr size_t kSteps = 200;

    struct Step {
        Document document;
        std::string ids;  ///< separated by spaces
    };
    static std::optional<Document> move(std::vector<Step>& from, std::vector<Step>& to, const Document& present) {
        if (from.empty()) return std::nullopt;
        Step step = std::move(from.back());
        from.pop_back();
        to.push_back({present, step.ids});
        if ((' ' + step.ids + ' ').find(" time ") == std::string::npos) step.document.setTime(present.time());
        return std::move(step.document);
    }

    std::vector<Step> undo_, redo_;
    std::string ids_;
    bool open_ = false;
};

}  // namespace lumi
