#pragma once
#include <map>
#include <optional>
#include <set>
#include <string>
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
    bool hasGroup(const std::string& prefix) const;
    /// What a scene has of a kind, "material" or "light": of ids "<kind>.<name>.<parameter>" the names, in order.
    const std::vector<std::string>& names(const std::string& kind) const;
    const ParameterInfo* find(const std::string& id) const;
    bool changed(const std::string& id) const { return changed_.count(id) > 0; }
    const std::set<std::string>& changedIds() const { return changed_; }

    std::string text(const std::string& id) const;  ///< empty if there is no such id
    float number(const std::string& id, float fallback) const;

private:
    /// Parameters, found by how their ids begin.
    class Table {
    public:
        void fill(std::vector<ParameterInfo> parameters);
        /// Puts values in the place of those of the same ids.
        void update(std::vector<ParameterInfo> parameters);
        std::vector<const ParameterInfo*> group(const std::string& prefix) const;
        bool hasGroup(const std::string& prefix) const;
        const ParameterInfo* find(const std::string& id) const;
        const std::vector<ParameterInfo>& all() const { return parameters_; }

    private:
        /// The first place in byId_ whose id is not less.
        std::vector<ParameterInfo*>::const_iterator lowest(const std::string& id) const;
        std::vector<ParameterInfo> parameters_;
        std::vector<ParameterInfo*> byId_;  ///< sorted
    };

    void nameThings();

    std::optional<Document> document_;
    std::shared_ptr<const Scene> loaded_, scene_;
    Camera camera_;
    Table ofScene_, others_;  ///< scenes may have very many parameters, and few change from frame to frame
    std::map<std::string, std::vector<std::string>> names_;
    std::set<std::string> changed_;
    uint64_t revision_ = 0;
};

}  // namespace lumi
