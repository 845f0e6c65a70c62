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
        undo_.push_back(before);
        ids_ = ids;
        open_ = true;
    }
    void end() { open_ = false; }
    void clear() { *this = {}; }

    /// The document before the last step, or nothing; `present` is what redo() gives back.
    std::optional<Document> undo(const Document& present) { return move(undo_, redo_, present); }
    std::optional<Document> redo(const Document& present) { return move(redo_, undo_, present); }

private:
    static constexpr size_t kSteps = 200;

    std::optional<Document> move(std::vector<Document>& from, std::vector<Document>& to, const Document& present) {
        open_ = false;
        if (from.empty()) return std::nullopt;
        to.push_back(present);
        std::optional<Document> document = std::move(from.back());
        from.pop_back();
        return document;
    }

    std::vector<Document> undo_, redo_;
    std::string ids_;
    bool open_ = false;
};

}  // namespace lumi
