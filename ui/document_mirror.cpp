#include "ui/document_mirror.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace lumi {

void DocumentMirror::Table::fill(std::vector<ParameterInfo> parameters) {
    parameters_ = std::move(parameters);
    byId_.clear();
    for (ParameterInfo& info : parameters_) byId_.push_back(&info);
    std::sort(byId_.begin(), byId_.end(), [](const ParameterInfo* a, const ParameterInfo* b) { return a->id < b->id; });
}

void DocumentMirror::Table::update(std::vector<ParameterInfo> parameters) {
    for (ParameterInfo& info : parameters)
        if (const auto place = lowest(info.id); place != byId_.end() && (*place)->id == info.id)
            **place = std::move(info);
}

std::vector<ParameterInfo*>::const_iterator DocumentMirror::Table::lowest(const std::string& id) const {
    return std::lower_bound(byId_.begin(), byId_.end(), id,
                            [](const ParameterInfo* info, const std::string& wanted) { return info->id < wanted; });
}

std::vector<const ParameterInfo*> DocumentMirror::Table::group(const std::string& prefix) const {
    const auto first = lowest(prefix);
    const auto last =
        std::find_if(first, byId_.end(), [&](const ParameterInfo* info) { return !info->id.starts_with(prefix); });
    std::vector<const ParameterInfo*> found(first, last);
    std::sort(found.begin(), found.end());  // they lie in one array, in order
    return found;
}

bool DocumentMirror::Table::hasGroup(const std::string& prefix) const {
    const auto first = lowest(prefix);
    return first != byId_.end() && (*first)->id.starts_with(prefix);
}

const ParameterInfo* DocumentMirror::Table::find(const std::string& id) const {
    const auto place = lowest(id);
    return place != byId_.end() && (*place)->id == id ? *place : nullptr;
}

bool DocumentMirror::refresh(const Session& session) {
    if (!session.hasScene()) return false;
    const uint64_t revision = session.revision();
    if (document_ && revision == revision_) return false;
    revision_ = revision;
    document_.emplace(session.document());
    camera_ = document_->camera();
    others_.fill(document_->list("", Document::Part::Others));
    if (loaded_ != document_->loadedScene()) {
        loaded_ = document_->loadedScene();
        ofScene_.fill(document_->list("", Document::Part::OfScene));
        nameThings();
    } else if (scene_ != document_->scene()) {
        ofScene_.update(document_->listUnlike(*scene_));
    }
    scene_ = document_->scene();
    changed_.clear();
    const nlohmann::json changes = document_->changedValues();
    for (const auto& [id, value] : changes.items()) changed_.insert(id);
    return true;
}

void DocumentMirror::nameThings() {
    names_.clear();
    for (const ParameterInfo& info : ofScene_.all()) {
        const size_t begin = info.id.find('.') + 1, end = info.id.rfind('.');
        if (end < begin) continue;
        std::vector<std::string>& names = names_[info.id.substr(0, begin - 1)];
        std::string name = info.id.substr(begin, end - begin);
        if (names.empty() || names.back() != name) names.push_back(std::move(name));
    }
}

std::vector<const ParameterInfo*> DocumentMirror::group(const std::string& prefix) const {
    std::vector<const ParameterInfo*> found = others_.group(prefix);
    const std::vector<const ParameterInfo*> ofScene = ofScene_.group(prefix);
    found.insert(found.end(), ofScene.begin(), ofScene.end());
    return found;
}

bool DocumentMirror::hasGroup(const std::string& prefix) const {
    return others_.hasGroup(prefix) || ofScene_.hasGroup(prefix);
}

const std::vector<std::string>& DocumentMirror::names(const std::string& kind) const {
    static const std::vector<std::string> none;
    const auto found = names_.find(kind);
    return found == names_.end() ? none : found->second;
}

const ParameterInfo* DocumentMirror::find(const std::string& id) const {
    const ParameterInfo* found = others_.find(id);
    return found ? found : ofScene_.find(id);
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
