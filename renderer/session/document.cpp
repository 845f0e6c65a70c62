#include "session/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "base/error.h"
#include "params/json.h"
#include "reconstruct/catalog.h"
#include "scene/camera_track.h"
#include "scene/light_body.h"
#include "scene/reach.h"
#include "scene/shutter_segments.h"
#include "session/document_fields.h"

namespace lumi {
using nlohmann::json;
namespace {

std::string slug(const std::string& name) {
    std::string text;
    for (const unsigned char c : name) {
        if (std::isalnum(c)) text += static_cast<char>(std::tolower(c));
        else if (!text.empty() && text.back() != '-') text += '-';
    }
    while (!text.empty() && text.back() == '-') text.pop_back();
    return text;
}

template <class Things>
std::vector<std::string> namesOf(const Things& things, const std::string& kind) {
    std::vector<std::string> names;
    for (const auto& thing : things) names.push_back(thing.name);
    return slugs(names, kind);
}

/// Empty for the material of light bodies: nothing shows it, so it has no parameters.
std::vector<std::string> materialNames(const Scene& scene) {
    std::vector<std::string> names = namesOf(scene.materials, "material");
    const std::vector<bool> ofBodies = bodyMaterials(scene);
    for (size_t i = 0; i < names.size(); ++i)
        if (ofBodies[i]) names[i].clear();
    return names;
}

std::vector<std::string> cameraNames(const Scene& scene) {
    std::vector<std::string> names;
    for (const SceneCamera& camera : scene.cameras) names.push_back(camera.camera.name);
    return slugs(names, "camera");
}

bool sameValues(const std::vector<ParameterInfo>& a, const std::vector<ParameterInfo>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const ParameterInfo& x, const ParameterInfo& y) {
        return x.id == y.id && x.value == y.value;
    });
}

[[noreturn]] void throwUnknownId(const Document& document, const std::string& id, const std::string& where) {
    std::vector<std::string> ids;
    for (const ParameterInfo& info : document.list()) ids.push_back(info.id);
    for (const ModuleEntry& entry : moduleCatalog())
        for (const ParameterInfo& info : document.list(std::string(entry.id) + ".")) ids.push_back(info.id);
    const std::string near = nearestName(id, ids);
    throwUsage({fmt::format("unknown parameter \"{}\"", id), where,
                near.empty() ? "an id from `lumiscope list parameters`" : '"' + near + '"', ""});
}

/// Throws Error(Usage) naming the nearest id if there is none of this name.
ParameterInfo declaration(const Document& document, const std::string& id) {
    for (ParameterInfo& info : document.list(id))
        if (info.id == id) return std::move(info);
    throwUnknownId(document, id, "");
}

/// Which of two ids is set first so that none undoes another: what is loaded or selected goes before its edits.
int setOrder(const std::string& id) {
    if (id.compare(0, 6, "scene.") == 0) return 0;
    if (id == "time" || id == "camera.select" || id == "environment.file") return 1;
    if (id.size() > 7 && id.compare(0, 5, "view.") == 0 && id.substr(6) == ".module") return 1;
    return 2;
}

}  // namespace

std::vector<std::string> slugs(const std::vector<std::string>& names, const std::string& kind) {
    std::vector<std::string> result;
    std::set<std::string> taken;
    std::map<std::string, int> nextCopy;  // smaller numbers of that name are taken
    for (size_t i = 0; i < names.size(); ++i) {
        std::string base = slug(names[i]);
        if (base.empty()) base = fmt::format("{}-{}", kind, i + 1);
        std::string unique = base;
        for (int& copy = nextCopy.try_emplace(base, 2).first->second; !taken.insert(unique).second; ++copy)
            unique = fmt::format("{}-{}", base, copy);
        result.push_back(unique);
    }
    return result;
}

void ViewSettings::describe(ParameterVisitor& v) {
    v.text("module", module,
           {.label = "Method", .help = "Module instance that the view shows, as svgf or svgf@b", .redo = Redo::Filter});
    v.text("buffer", buffer,
           {.label = "Buffer", .help = "`image`, a signal or one of the module's taps", .redo = Redo::Filter});
    display.describe(v);
}

void RenderSettings::describe(ParameterVisitor& v) {
    v.integer("width", width,
              {.label = "Width",
               .min = 1,
               .max = 16384,
               .unit = "px",
               .help = "Width of the rendered image",
               .redo = Redo::Samples});
    v.integer("height", height,
              {.label = "Height",
               .min = 1,
               .max = 16384,
               .unit = "px",
               .help = "Height of the rendered image",
               .redo = Redo::Samples});
    v.integer("spp", samplesPerPixel,
              {.label = "Samples a frame",
               .min = 1,
               .max = 65536,
               .scale = Scale::Log,
               .unit = "spp",
               .help = "Samples a pixel in each frame",
               .redo = Redo::Samples});
    v.integer("seed", seed,
              {.label = "Seed",
               .min = 0,
               .max = 1e9,
               .help = "Selects another set of random numbers",
               .redo = Redo::Samples});
    v.number("fps", fps,
             {.label = "Frames a second",
              .min = 0.1,
              .max = 1000,
              .scale = Scale::Log,
              .unit = "Hz",
              .help = "Time goes on by the inverse of this with each frame while it plays; so the shutter's time "
                      "depends on it",
              .redo = Redo::Samples});
}

Document::Document(std::shared_ptr<const Scene> scene) : loaded_(scene), edited_(std::move(scene)) {
    names_ = std::make_shared<Names>(
        Names{materialNames(*loaded_), namesOf(loaded_->lights, "light"), cameraNames(*loaded_)});
    // At rest things may lie where no frame has them.
    const float radius = loaded_->restBounds().radius();
    sceneRadius_ = isInReach(radius) ? radius : kReach;
    const RenderDefaults& defaults = loaded_->render;
    render_.width = defaults.size.width;
    render_.height = defaults.size.height;
    render_.fps = defaults.fps;
    for (ViewSettings& view : views_) view.display.exposureEv = defaults.exposureEv;
    views_[0].module = defaults.module;
    // what the first view made of the same samples
    views_[1].module = defaults.module == "none" ? "accumulate" : "none";
    try {
        findModule(defaults.module, loaded_->path + ": render.module");
        for (const auto& [id, text] : defaults.set) setText(id, text, loaded_->path + ": render.set");
    } catch (const Error& error) {
        throw Error(ErrorKind::BadInput, error.text());
    }
    initial_ = std::make_shared<Document>(*this);
}

Camera Document::cameraAt(float time) const {
    Camera camera = lumi::cameraAt(*edited_, camera_, time);
    const Describe describe = [&](ParameterVisitor& v) { camera.describe(v); };
    for (const auto& [name, value] : cameraEdits_) setParameter(describe, name, value);
    return camera;
}

CameraTrack Document::cameraTrack() const {
    const float open = camera().shutter / render_.fps;
    if (!(open > 0) || !cameraMoves()) return {};
    const SceneCamera& source = edited_->cameras[static_cast<size_t>(camera_)];
    return lumi::cameraTrack([&](float part) { return cameraAt(time_ + open * part); },
                             shutterTurns(*edited_, source, time_, time_ + open), {render_.width, render_.height});
}

std::vector<std::string> Document::activeInstances() const {
    std::vector<std::string> names{views_[0].module};
    if (layout_ != Layout::Single && views_[1].module != views_[0].module) names.push_back(views_[1].module);
    return names;
}

void Document::configure(const std::string& instance, Module& module) const {
    const auto values = instances_.find(instance);
    const Describe describe = [&](ParameterVisitor& v) { module.describe(v); };
    // A value that is no longer set goes back to its default, which a fresh module knows.
    const auto fresh = findModule(instance).make();
    for (const ParameterInfo& info : listParameters([&](ParameterVisitor& v) { fresh->describe(v); })) {
        ParameterValue value = info.value;
        if (values != instances_.end())
            if (const auto set = values->second.find(info.id); set != values->second.end()) value = set->second;
        setParameter(describe, info.id, value);
    }
}

bool Document::cameraMoves() const {
    const SceneCamera& camera = edited_->cameras[static_cast<size_t>(camera_)];
    return camera.node >= 0 || camera.keys.size() > 1;
}

Redo Document::set(const std::string& id, const ParameterValue& value, const std::string& where) {
    for (const DocumentFields::Group& group : DocumentFields::groups(*this, id)) {
        if (id.compare(0, group.prefix.size(), group.prefix) != 0) continue;
        const std::vector<ParameterInfo> before = listParameters(group.describe);
        const Redo redo = setParameter(group.describe, id, value, where);
        const bool fixes = group.prefix == "camera." && id != "camera.jitter" && cameraMoves();
        if (id != "camera.select" && !fixes && sameValues(before, listParameters(group.describe)))
            return Redo::Display;  // nothing new
        group.commit(*this, id.substr(group.prefix.size()), value, where);
        return redo;
    }
    throwUnknownId(*this, id, where);
}

Redo Document::setText(const std::string& id, const std::string& text, const std::string& where) {
    for (const ParameterInfo& info : list(id)) {
        if (info.id != id) continue;
        if (id == "camera.select") {
            // Besides the slug: the name as the file has it, or the camera's number.
            for (size_t i = 0; i < names_->cameras.size(); ++i)
                if (text == loaded_->cameras[i].camera.name || text == std::to_string(i))
                    return set(id, names_->cameras[i], where);
        }
        return set(id, parseParameter(info, text, where), where);
    }
    throwUnknownId(*this, id, where);
}

ParameterValue Document::get(const std::string& id) const { return declaration(*this, id).value; }

ParameterValue Document::initial(const std::string& id) const {
    if (!initial_) return get(id);
    Document before = *initial_;
    before.time_ = time_;
    if (id != "camera.select") before.camera_ = camera_;
    return before.get(id);
}

Redo Document::resetOne(const std::string& id) {
    const ParameterInfo declared = declaration(*this, id);
    if (!initial_) return Redo::Display;
    if (id == "time") return set(id, initial_->time_);
    if (id == "environment.file") return environmentDigest_.empty() ? Redo::Display : set(id, std::string());
    const bool ofPose = id.starts_with("camera.") && id != "camera.select" && id != "camera.jitter";
    if (!ofPose) return set(id, initial(id));
    return cameraEdits_.erase(id.substr(std::string_view("camera.").size())) > 0 ? declared.redo : Redo::Display;
}

Redo Document::reset(std::vector<std::string> ids) {
    std::stable_sort(ids.begin(), ids.end(),
                     [](const std::string& a, const std::string& b) { return setOrder(a) < setOrder(b); });
    Redo worst = Redo::Display;
    for (const std::string& id : ids) worst = std::max(worst, resetOne(id));
    return worst;
}

std::vector<ParameterInfo> Document::list(const std::string& filter, Part part) const {
    std::vector<ParameterInfo> all;
    for (const DocumentFields::Group& group : DocumentFields::groups(*this, filter, part))
        for (ParameterInfo& info : listParameters(group.describe))
            if (info.id.compare(0, filter.size(), filter) == 0) all.push_back(std::move(info));
    return all;
}

std::vector<ParameterInfo> Document::listUnlike(const Scene& other) const {
    std::vector<ParameterInfo> all;
    for (const DocumentFields::Group& group : DocumentFields::groups(*this, "", Part::OfScene, &other))
        for (ParameterInfo& info : listParameters(group.describe)) all.push_back(std::move(info));
    return all;
}

json Document::changedValues() const { return initial_ ? difference(*initial_, *this) : json::object(); }

json Document::difference(const Document& from, const Document& to) {
    json changes = json::object();
    if (from.time_ != to.time_) changes["time"] = to.time_;
    // The camera's edits hold for all times, so they are told one by one; leaving some out means selecting it again.
    const bool fewer = std::any_of(from.cameraEdits_.begin(), from.cameraEdits_.end(),
                                   [&](const auto& edit) { return !to.cameraEdits_.count(edit.first); });
    const bool again = fewer || from.camera_ != to.camera_;
    if (again) changes["camera.select"] = to.names_->cameras[static_cast<size_t>(to.camera_)];
    for (const auto& [name, value] : to.cameraEdits_) {
        const auto same = from.cameraEdits_.find(name);
        if (again || same == from.cameraEdits_.end() || same->second != value)
            changes["camera." + name] = toJson(value);
    }
    if (from.jitter_ != to.jitter_) changes["camera.jitter"] = toJson(to.get("camera.jitter"));

    const bool otherSky = from.environmentDigest_ != to.environmentDigest_ ||
                          from.edited_->environment.file != to.edited_->environment.file;
    const Part part = from.edited_ == to.edited_ ? Part::Others : Part::All;
    const auto isTold = [](const DocumentFields::Group& group) {
        return group.prefix != "camera." && group.prefix != "time";
    };
    const bool isSameScene = from.loaded_ == to.loaded_;
    std::map<std::string, ParameterValue> before;
    std::set<std::string> known;
    for (const DocumentFields::Group& group :
         DocumentFields::groups(from, "", part, isSameScene ? to.edited_.get() : nullptr)) {
        if (!isTold(group)) continue;
        known.insert(group.prefix);
        for (const ParameterInfo& info : listParameters(group.describe)) before[info.id] = info.value;
    }
    for (const DocumentFields::Group& group :
         DocumentFields::groups(to, "", part, isSameScene ? from.edited_.get() : nullptr)) {
        if (!isTold(group)) continue;
        // A module that only `to` shows: `from` knows its values if it is asked for them.
        if (!known.contains(group.prefix))
            for (const ParameterInfo& info : from.list(group.prefix)) before[info.id] = info.value;
        for (const ParameterInfo& info : listParameters(group.describe)) {
            const auto old = before.find(info.id);
            // A sky that is read, or put back, brings its own scale and rotation.
            const bool brought = otherSky && group.prefix == "environment.";
            if (brought || old == before.end() || old->second != info.value) changes[info.id] = toJson(info.value);
        }
    }
    if (otherSky && to.environmentDigest_.empty()) changes["environment.file"] = "";  // the scene's own
    addInstancesOf(from, to, changes);
    return changes;
}

/// Parameters of instances that `from` alone has set.
void Document::addInstancesOf(const Document& from, const Document& to, json& changes) {
    for (const auto& [instance, values] : from.instances_) {
        if (to.instances_.count(instance)) continue;
        const std::vector<ParameterInfo> goal = to.list(instance + ".");
        for (const auto& [name, value] : values)
            for (const ParameterInfo& info : goal)
                if (info.id == instance + '.' + name && info.value != value) changes[info.id] = toJson(info.value);
    }
}

void Document::apply(const json& values, const std::string& where) {
    std::vector<std::string> ids;
    for (const auto& [id, value] : values.items())
        if (id != kEnvironmentDigest) ids.push_back(id);
    std::stable_sort(ids.begin(), ids.end(),
                     [](const std::string& a, const std::string& b) { return setOrder(a) < setOrder(b); });
    for (const std::string& id : ids) {
        bool known = false;
        for (const ParameterInfo& info : list(id)) {
            if (info.id != id) continue;
            set(id, parameterFromJson(info, values[id], where), where);
            known = true;
        }
        if (!known) throwUnknownId(*this, id, where);
    }
    const auto digest = values.find(kEnvironmentDigest);
    if (digest != values.end() && *digest != environmentDigest_)
        throwBadInput({"the sky changed since the image was made", edited_->environment.file,
                       "content " + (digest->is_string() ? digest->get<std::string>() : digest->dump()),
                       environmentDigest_});
}

}  // namespace lumi
