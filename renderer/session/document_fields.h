#pragma once
#include <functional>
#include <string>
#include <vector>

#include "session/document.h"

namespace lumi {

/// Where each id of a Document lives. A group is one described object: a copy of it is described under the ids that
/// users know, and commit() puts the changed copy back.
class DocumentFields {
public:
    struct Group {
        std::string prefix;  ///< "path.", "material.floor."; the whole id for single values ("time")
        Describe describe;   ///< of the copy, full ids
        /// Puts the copy back; `name` is the id without its prefix.
        std::function<void(Document&, const std::string& name, const ParameterValue& value, const std::string& where)>
            commit;
    };

    /// Groups that hold ids beginning with `filter`, or that the id `filter` belongs to; without those of materials and
    /// lights that are as in `unlike`, an edit of the same loaded scene.
    static std::vector<Group> groups(const Document& document, const std::string& filter,
                                     Document::Part part = Document::Part::All, const Scene* unlike = nullptr);

private:
    friend class Document;
    static void addSettings(const Document&, const std::string& filter, std::vector<Group>&);
    static void addCamera(const Document&, const std::string& filter, std::vector<Group>&);
    static void addChoice(const Document&, const std::string& filter, std::vector<Group>&);
    static void addScene(const Document&, const std::string& filter, const Scene* unlike, std::vector<Group>&);
    static void addViews(const Document&, const std::string& filter, std::vector<Group>&);
    static void addInstances(const Document&, const std::string& filter, std::vector<Group>&);
    static Scene& edit(Document&);
    static void readSky(Document&, Environment& sky, const std::string& where);
};

/// Throws Error(Usage) unless a view of `instance` can show `buffer`.
void checkBuffer(const std::string& instance, const std::string& buffer, const std::string& where);

}  // namespace lumi
