#include "ui/document_mirror.h"

#include <nlohmann/json.hpp>

namespace lumi {

bool DocumentMirror::refresh(const Session& session) {
    if (!session.hasScene()) return false;
    const uint64_t revision = session.revision();
    if (document_ && revision == revision_) return false;
    revision_ = revision;
    document_.emplace(session.document());
    scene_ = document_->scene();
    camera_ = document_->camera();
    parameters_ = document_->list();
    index_.clear();
    for (size_t i = 0; i < parameters_.size(); ++i) index_.emplace(parameters_[i].id, i);
    changed_.clear();
    const nlohmann::json changes = document_->changedValues();
    for (const auto& [id, value] : changes.items()) changed_.insert(id);
    return true;
}

std::vector<const ParameterInfo*> DocumentMirror::group(const std::string& prefix) const {
    std::vector<const ParameterInfo*> found;
    for (const ParameterInfo& info : parameters_)
        if (info.id.compare(0, prefix.size(), prefix) == 0) found.push_back(&info);
    return found;
}

const ParameterInfo* DocumentMirror::find(const std::string& id) const {
    const auto entry = index_.find(id);
    return entry == index_.end() ? nullptr : &parameters_[entry->second];
}

std::string DocumentMirror::text(const std::string& id) const {
    const ParameterInfo* info = find(id);
    return info ? formatParameter(info->value) : std::string();
}

float DocumentMirror::number(const std::string& id, float fallback) const {
    const ParameterInfo* info = find(id);
    if (!info) return fallback;
    if (const float* value = std::get_if<float>(&info->value)) return *value;
    if (const int* value = std::get_if<int>(&info->value)) return static_cast<float>(*value);
    return fallback;
}

}  // namespace lumi
