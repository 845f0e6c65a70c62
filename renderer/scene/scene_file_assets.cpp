#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "base/error.h"
#include "base/files.h"
#include "base/parallel.h"
#include "scene/gltf/choices.h"
#include "scene/gltf/load_gltf.h"
#include "scene/obj/load_obj.h"
#include "scene/procedural/procedural.h"
#include "scene/scene_file_parts.h"

namespace lumi {
namespace {

/// One entry of "assets", read but not yet loaded.
struct AssetSource {
    const JsonMember* member;
    std::string kind;  ///< "gltf", "obj" or a generator's name
    const JsonValue* kindValue;
    std::string file;
    SceneChoice choice;
    const JsonValue *sceneValue = nullptr, *variantValue = nullptr, *animationValue = nullptr;
    Subdivision subdivision;
    std::unique_ptr<Procedural> generator;
};

std::vector<std::string> assetKinds() {
    std::vector<std::string> kinds{"gltf", "obj"};
    for (const ProceduralEntry& entry : proceduralCatalog()) kinds.emplace_back(entry.name);
    return kinds;
}

AssetSource readAsset(SceneFileContext& context, const JsonMember& member) {
    AssetSource source;
    source.member = &member;
    ObjectReader reader(context.tree, member.value, member.key);
    for (const std::string& kind : assetKinds()) {
        const JsonValue* value = reader.find(kind.c_str());
        if (!value) continue;
        if (!source.kind.empty())
            reader.fail(value->at,
                        fmt::format("asset \"{}\" is both \"{}\" and \"{}\"", member.key, source.kind, kind));
        source.kind = kind;
        source.kindValue = value;
    }
    if (source.kind.empty()) {
        reader.finish();
        reader.fail(member.value.at, fmt::format("asset \"{}\" says nothing of what it is", member.key),
                    "one of " + quotedList(assetKinds()));
    }
    if (source.kind == "gltf" || source.kind == "obj") {
        source.file = readText(context.tree, *source.kindValue, source.kind);
        if (source.kind == "obj") reader.parameters([&](ParameterVisitor& v) { source.subdivision.describe(v); });
        if (source.kind == "gltf") {
            source.sceneValue = reader.find("scene");
            source.variantValue = reader.find("variant");
            source.animationValue = reader.find("animation");
            source.choice.index = reader.integer("scene", 0, 1 << 20).value_or(-1);
            source.choice.variant = reader.text("variant").value_or("");
            source.choice.animation = reader.text("animation").value_or("");
        }
    } else {
        source.generator = makeProcedural(source.kind);
        ObjectReader parameters(context.tree, *source.kindValue, source.kind);
        parameters.parameters([&](ParameterVisitor& v) { source.generator->describe(v); });
        parameters.finish();
    }
    reader.finish();
    return source;
}

/// What to point at when a file does not have what it is asked for.
const JsonValue& refusedChoice(const AssetSource& source, const std::filesystem::path& path) {
    const gltf::Choices there = gltf::readChoices(path);
    if (source.choice.index >= static_cast<int>(there.scenes.size())) return *source.sceneValue;
    const auto& variants = there.variants;
    if (source.variantValue && std::find(variants.begin(), variants.end(), source.choice.variant) == variants.end())
        return *source.variantValue;
    return source.animationValue ? *source.animationValue : *source.kindValue;
}

Scene loadAssetFile(const SceneFileContext& context, const AssetSource& source, float begin, float end) {
    LoadOptions options = context.options;
    options.choice = source.choice;
    options.subdivision = source.subdivision;
    if (context.options.progress)
        options.progress = [&](float fraction, const std::string& step) {
            context.options.progress(begin + fraction * (end - begin), step);
        };
    std::filesystem::path path;
    try {
        path = context.resolve(source.file);
        return source.kind == "gltf" ? loadGltf(path, context.log, options) : loadObj(path, context.log, options);
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::Interrupted) throw;
        const bool isChoice = error.kind() == ErrorKind::Usage;
        const JsonValue& at = isChoice ? refusedChoice(source, path) : *source.kindValue;
        throw Error(
            isChoice ? ErrorKind::BadInput : error.kind(),
            {fmt::format("asset \"{}\": {}", source.member->key, error.what()), context.tree.where(at.at), "", ""});
    }
}

/// Names of the assets that instances ask for; anything malformed is left for readInstances() to report.
std::set<std::string> usedAssets(const JsonValue* instances) {
    std::set<std::string> used;
    if (!instances) return used;
    for (const JsonValue& instance : instances->items)
        for (const JsonMember& member : instance.members)
            if (member.key == "asset") used.insert(member.value.text);
    return used;
}

void buildGenerated(SceneFileContext& context, const std::vector<AssetSource*>& generated) {
    std::vector<std::optional<Error>> errors(generated.size());
    std::vector<Scene> scenes(generated.size());
    parallelFor(
        static_cast<int64_t>(generated.size()),
        [&](int64_t index) {
            const auto i = static_cast<size_t>(index);
            try {
                scenes[i] = sceneFromProcedural(generated[i]->generator->build());
            } catch (const Error& error) {
                errors[i] = error;
            }
        },
        context.options.stop);
    context.checkStop();
    for (size_t i = 0; i < generated.size(); ++i) {
        const AssetSource& source = *generated[i];
        if (errors[i]) {
            const ErrorText& text = errors[i]->text();
            const ErrorKind kind = errors[i]->kind() == ErrorKind::Usage ? ErrorKind::BadInput : errors[i]->kind();
            throw Error(kind, {fmt::format("asset \"{}\": {}", source.member->key, text.what),
                               context.tree.where(source.kindValue->at), text.expected, text.found});
        }
        context.assets[source.member->key].content = std::move(scenes[i]);
    }
}

}  // namespace

void Subdivision::describe(ParameterVisitor& v) {
    v.choice("subdivision", scheme,
             {.label = "Subdivision",
              .options = {"auto", "none", "catmull-clark", "bilinear"},
              .help = "Of what surface the OBJ is the control cage; auto: as a comment \"# scheme: catmark\" or "
                      "\"# scheme: bilinear\" says, else of Catmull-Clark's where it has OpenSubdiv's tags "
                      "(t or #t lines).",
              .redo = Redo::Build});
    v.when(scheme != SubdivisionScheme::None, [&] {
        v.integer("rate", rate,
                  {.label = "Rate",
                   .min = 1,
                   .max = 64,
                   .scale = Scale::Log,
                   .help = "Segments along every edge of the cage.",
                   .redo = Redo::Build});
    });
}

void readAssets(SceneFileContext& context, const JsonValue* section, const JsonValue* instances) {
    std::vector<AssetSource> sources;
    for (const JsonMember& member : membersOf(context, section, "assets"))
        sources.push_back(readAsset(context, member));

    const std::set<std::string> used = usedAssets(instances);
    std::vector<AssetSource*> files, generated;
    for (AssetSource& source : sources) {
        context.assets[source.member->key].name = source.member->key;
        if (!used.contains(source.member->key)) {
            context.log.warning(fmt::format("{}: asset \"{}\" is used by no instance",
                                            context.tree.where(source.member->at), source.member->key));
            continue;
        }
        (source.generator ? generated : files).push_back(&source);
    }
    context.report(0.15f, "building shapes");
    buildGenerated(context, generated);
    for (size_t i = 0; i < files.size(); ++i) {
        context.checkStop();
        const auto count = static_cast<float>(files.size());
        const float begin = 0.2f + 0.7f * static_cast<float>(i) / count, end = begin + 0.7f / count;
        context.report(begin, "loading " + files[i]->file);
        Scene content = loadAssetFile(context, *files[i], begin, end);
        context.digests += content.contentDigest;
        context.assets[files[i]->member->key].content = std::move(content);
    }
    context.checkStop();
}

}  // namespace lumi
