#include "session/document_fields.h"

#include <fmt/format.h>

#include <atomic>
#include <filesystem>

#include "base/error.h"
#include "base/files.h"
#include "image/hdr.h"
#include "params/renaming_visitor.h"
#include "reconstruct/catalog.h"
#include "scene/asset_folder.h"

namespace lumi {
namespace {

bool startsWith(const std::string& text, const std::string& head) { return text.compare(0, head.size(), head) == 0; }

/// Does a group of this prefix hold ids that begin with `filter`, or the id `filter` itself?
bool concerns(const std::string& prefix, const std::string& filter) {
    return startsWith(prefix, filter) || startsWith(filter, prefix);
}

}  // namespace

void checkBuffer(const std::string& instance, const std::string& buffer, const std::string& where) {
    if (buffer == "image" || signalByName(buffer) != Signal::Count) return;
    std::vector<std::string> names{"image"};
    const auto module = findModule(instance, where).make();
    for (const Tap& tap : module->taps()) {
        if (tap.name == buffer) return;
        names.push_back(tap.name);
    }
    for (int i = 0; i < kSignalCount; ++i) names.emplace_back(signalInfo(static_cast<Signal>(i)).name);
    const std::string near = nearestName(buffer, names);
    throwUsage({fmt::format("unknown buffer \"{}\"", buffer), where,
                near.empty() ? "a name from `lumiscope list buffers`" : '"' + near + '"', ""});
}

std::vector<DocumentFields::Group> DocumentFields::groups(const Document& document, const std::string& filter,
                                                          Document::Part part, const Scene* unlike) {
    using Part = Document::Part;
    std::vector<Group> groups;
    if (part != Part::OfScene) {
        addSettings(document, filter, groups);
        addCamera(document, filter, groups);
        addChoice(document, filter, groups);
    }
    if (part != Part::Others) addScene(document, filter, unlike, groups);
    if (part != Part::OfScene) {
        addViews(document, filter, groups);
        addInstances(document, filter, groups);
    }
    return groups;
}

void DocumentFields::addSettings(const Document& document, const std::string& filter, std::vector<Group>& groups) {
    if (concerns("render.", filter)) {
        auto copy = std::make_shared<RenderSettings>(document.render_);
        groups.push_back({"render.",
                          [copy](ParameterVisitor& v) {
                              RenamingVisitor renamed(v, "render.");
                              copy->describe(renamed);
                          },
                          [copy](Document& d, const auto&, const auto&, const auto&) { d.render_ = *copy; }});
    }
    for (const std::string prefix : {"path.", "sampler."}) {
        if (!concerns(prefix, filter)) continue;
        auto copy = std::make_shared<PathSettings>(document.path_);
        groups.push_back({prefix,
                          [copy, prefix](ParameterVisitor& v) {
                              RenamingVisitor renamed(v, [prefix](const std::string& id) {
                                  return startsWith(id, prefix) ? id : std::string();
                              });
                              copy->describe(renamed);
                          },
                          [copy](Document& d, const auto&, const auto&, const auto&) { d.path_ = *copy; }});
    }
    if (concerns("time", filter)) {
        auto copy = std::make_shared<float>(document.time_);
        groups.push_back({"time",
                          [copy](ParameterVisitor& v) {
                              v.number("time", *copy,
                                       {.label = "Time",
                                        .min = 0,
                                        .max = 1e6,
                                        .unit = "s",
                                        .help = "Moment of the animation that the frame shows",
                                        .redo = Redo::Build});
                          },
                          [copy](Document& d, const auto&, const auto&, const auto&) { d.time_ = *copy; }});
    }
}

void DocumentFields::addCamera(const Document& document, const std::string& filter, std::vector<Group>& groups) {
    if (!concerns("camera.", filter)) return;
    struct Copy {
        int index;
        Jitter jitter;
        Camera camera;
        std::shared_ptr<const Document::Names> names;
    };
    auto copy = std::make_shared<Copy>(Copy{document.camera_, document.jitter_, document.camera(), document.names_});
    const auto describe = [copy](ParameterVisitor& v) {
        std::vector<const char*> options;
        for (const std::string& name : copy->names->cameras) options.push_back(name.c_str());
        v.choiceIndex("camera.select", copy->index,
                      {.label = "Camera",
                       .options = options,
                       .help = "Which camera of the scene is looked through; choosing one drops what was flown",
                       .redo = Redo::Samples});
        v.choice(
            "camera.jitter", copy->jitter,
            {.label = "Jitter",
             .options = {"auto", "per-frame", "per-pixel", "none"},
             .help = "Where in its pixel a camera ray goes: one offset for the whole frame, one for each pixel, the "
                     "centre, or what the first view's module prefers",
             .redo = Redo::Samples});
        RenamingVisitor renamed(v, "camera.");
        copy->camera.describe(renamed);
    };
    groups.push_back(
        {"camera.", describe, [copy](Document& d, const std::string& name, const auto& value, const auto&) {
             if (name == "select") {
                 d.camera_ = copy->index;
                 d.cameraEdits_.clear();
             } else if (name == "jitter") {
                 d.jitter_ = copy->jitter;
             } else {
                 d.cameraEdits_[name] = value;
             }
         }});
}

Scene& DocumentFields::edit(Document& document) {
    auto scene = std::make_shared<Scene>(*document.edited_);
    static std::atomic<uint64_t> lastVersion{0};
    scene->version = ++lastVersion;
    document.edited_ = scene;
    return *scene;
}

void Document::adoptSkyImage(const Document& other) {
    Environment& sky = DocumentFields::edit(*this).environment;
    sky.file = other.edited_->environment.file;
    sky.image = other.edited_->environment.image, sky.standIn = other.edited_->environment.standIn;
    environmentDigest_ = other.environmentDigest_;
}

/// Reads the image that `sky` names; without a name it becomes the scene's own sky.
void DocumentFields::readSky(Document& document, Environment& sky, const std::string& where) {
    if (sky.file.empty()) {
        sky = document.loaded_->environment;
        document.environmentDigest_.clear();
        return;
    }
    std::filesystem::path path = isAssetName(sky.file) ? findAsset(sky.file) : std::filesystem::path(sky.file);
    const std::filesystem::path beside = std::filesystem::path(where).parent_path() / path;
    if (!std::filesystem::exists(path) && std::filesystem::exists(beside)) path = beside;
    sky.image = std::make_shared<Image>(loadImage(path));
    sky.standIn = nullptr;
    document.environmentDigest_ = digest(readFile(path));
}

void DocumentFields::addChoice(const Document& document, const std::string& filter, std::vector<Group>& groups) {
    if (!concerns("scene.", filter)) return;
    auto copy = std::make_shared<SceneChoice>(document.sceneChoice_);
    groups.push_back({"scene.", [copy](ParameterVisitor& v) { copy->describe(v); },
                      [copy](Document& d, const auto&, const auto&, const auto&) { d.sceneChoice_ = *copy; }});
}

void DocumentFields::addScene(const Document& document, const std::string& filter, const Scene* unlike,
                              std::vector<Group>& groups) {
    if (concerns("environment.", filter)) {
        auto copy = std::make_shared<Environment>(document.edited_->environment);
        groups.push_back({"environment.",
                          [copy](ParameterVisitor& v) {
                              v.text("environment.file", copy->file,
                                     {.label = "Sky image",
                                      .help = "Equirectangular .hdr or .exr; empty keeps the scene's own sky",
                                      .redo = Redo::Samples});
                              RenamingVisitor renamed(v, [](const std::string& name) {
                                  return name == "file" ? std::string() : "environment." + name;
                              });
                              copy->describe(renamed);
                          },
                          [copy](Document& d, const std::string& name, const auto&, const std::string& where) {
                              if (name == "file") readSky(d, *copy, where);
                              copy->chooseStandIn();
                              edit(d).environment = *copy;
                          }});
    }
    for (size_t i = 0; i < document.names_->materials.size(); ++i) {
        const std::string prefix = "material." + document.names_->materials[i] + ".";
        if (!concerns(prefix, filter) || document.names_->materials[i].empty()) continue;
        if (unlike && document.edited_->materials[i] == unlike->materials[i]) continue;
        auto copy = std::make_shared<Material>(document.edited_->materials[i]);
        groups.push_back(
            {prefix,
             [copy, prefix](ParameterVisitor& v) {
                 RenamingVisitor renamed(v, prefix);
                 copy->describe(renamed);
             },
             [copy, i](Document& d, const auto&, const auto&, const auto&) { edit(d).materials[i] = *copy; }});
    }
    for (size_t i = 0; i < document.names_->lights.size(); ++i) {
        const std::string prefix = "light." + document.names_->lights[i] + ".";
        if (!concerns(prefix, filter)) continue;
        if (unlike && document.edited_->lights[i] == unlike->lights[i]) continue;
        auto copy = std::make_shared<Light>(document.edited_->lights[i]);
        groups.push_back(
            {prefix,
             [copy, prefix](ParameterVisitor& v) {
                 RenamingVisitor renamed(v, prefix);
                 copy->describe(renamed);
             },
             [copy, i](Document& d, const auto&, const auto&, const auto&) { edit(d).lights[i] = *copy; }});
    }
}

void DocumentFields::addViews(const Document& document, const std::string& filter, std::vector<Group>& groups) {
    if (concerns("view.layout", filter)) {
        auto copy = std::make_shared<Layout>(document.layout_);
        groups.push_back({"view.layout",
                          [copy](ParameterVisitor& v) {
                              v.choice("view.layout", *copy,
                                       {.label = "Views",
                                        .options = {"single", "side-by-side", "wipe"},
                                        .help = "One view, two beside each other, or two with a line between them"});
                          },
                          [copy](Document& d, const auto&, const auto&, const auto&) { d.layout_ = *copy; }});
    }
    for (size_t i = 0; i < document.views_.size(); ++i) {
        const std::string prefix = fmt::format("view.{}.", i);
        if (!concerns(prefix, filter)) continue;
        auto copy = std::make_shared<ViewSettings>(document.views_[i]);
        groups.push_back({prefix,
                          [copy, prefix](ParameterVisitor& v) {
                              RenamingVisitor renamed(v, prefix);
                              copy->describe(renamed);
                          },
                          [copy, i](Document& d, const std::string& name, const auto&, const std::string& where) {
                              if (name == "module") {
                                  findModule(copy->module, where);
                                  try {
                                      checkBuffer(copy->module, copy->buffer, where);
                                  } catch (const Error&) {
                                      copy->buffer = "image";  // a tap that the new module does not have
                                  }
                              }
                              if (name == "buffer") checkBuffer(copy->module, copy->buffer, where);
                              d.views_[i] = *copy;
                          }});
    }
}

void DocumentFields::addInstances(const Document& document, const std::string& filter, std::vector<Group>& groups) {
    std::vector<std::string> names;
    const auto add = [&](const std::string& name) {
        if (!concerns(name + ".", filter)) return;
        if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    };
    for (const ViewSettings& view : document.views_) add(view.module);
    for (const auto& [name, values] : document.instances_) add(name);
    const std::string named = filter.substr(0, filter.find('.'));
    for (const ModuleEntry& entry : moduleCatalog())
        if (named.substr(0, named.find('@')) == entry.id) add(named);

    for (const std::string& instance : names) {
        std::shared_ptr<Module> module = findModule(instance).make();
        document.configure(instance, *module);
        const std::string prefix = instance + ".";
        groups.push_back({prefix,
                          [module, prefix](ParameterVisitor& v) {
                              RenamingVisitor renamed(v, prefix);
                              module->describe(renamed);
                          },
                          [instance](Document& d, const std::string& name, const ParameterValue& value, const auto&) {
                              d.instances_[instance][name] = value;
                          }});
    }
}

}  // namespace lumi
