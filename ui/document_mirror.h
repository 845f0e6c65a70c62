#pragma once
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "session/session.h"

namespace lumi {

/// The session's document as the panels read it; copied only when it changed.
class DocumentMirror {
public:
    /// True if something changed since the last call.
    bool refresh(const Session& session);

    bool present() const { return document_.has_value(); }
    const Document& document() const { return *document_; }
    const Scene* scene() const { return scene_.get(); }
    const Camera& camera() const { return camera_; }

    /// Declarations with present values, in order, of ids that begin with `prefix`.
    std::vector<const ParameterInfo*> group(const std::string& prefix) const;
    const ParameterInfo* find(const std::string& id) const;
    bool changed(const std::string& id) const { return changed_.count(id) > 0; }
    const std::set<std::string>& changedIds() const { return changed_; }

    std::string text(const std::string& id) const;  ///< empty if there is no such id
    float number(const std::string& id, float fallback) const;

private:
    std::optional<Document> document_;
    std::shared_ptr<const Scene> scene_;
    Camera camera_;
    std::vector<ParameterInfo> parameters_;
    std::unordered_map<std::string, size_t> index_;
    std::set<std::string> changed_;
    uint64_t revision_ = 0;
};

}  // namespace lumi
