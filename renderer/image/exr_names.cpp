#include <algorithm>
#include <cstring>

#include "image/exr.h"

namespace lumi {
namespace {

/// What other tools call our layers; "" is the root. Earlier entries win where a file has several.
struct Alias {
    const char* theirs;
    const char* ours;
};
const Alias kLayerAliases[] = {
    {"Combined", ""},  // Blender, Open Image Denoise
    {"Beauty", ""},
    {"Composite.Combined", ""},
    {"Noisy Image", "noisy"},        // Blender
    {"Albedo", "albedo"},            // pbrt
    {"Denoising Albedo", "albedo"},  // Blender
    {"VisibleDiffuse", "albedo"},
    {"diffuse", "albedo"},
    {"DiffCol", "albedo"},
    {"Ns", "normal"},                // pbrt, shading
    {"Denoising Normal", "normal"},  // Blender
    {"Normals", "normal"},
    {"Normal", "normal"},
    {"nn", "normal"},              // Mitsuba
    {"N", "normal"},               // pbrt, geometric
    {"Denoising Depth", "depth"},  // Blender
    {"Depth", "depth"},
    {"dd", "depth"},                // Mitsuba
    {"P", "position"},              // pbrt
    {"worldPosition", "position"},  // OSPRay Studio
    {"Position", "position"},       // Blender
    {"Vector", "motion"},           // Blender
    {"mvec", "motion"},             // Falcor
    {"variance", "sampleVariance"},
    {"Variance", "sampleVariance"},  // pbrt
    {"RelativeVariance", "relativeVariance"},
};
const Alias kChannelAliases[] = {{"id", "objectId"}};

constexpr size_t kLayerAliasCount = std::size(kLayerAliases);

/// Letters by the kind of layer: some tools write normals as R, G, B and albedo as X, Y, Z.
std::string componentFor(std::string_view layer, std::string_view component) {
    if (component.size() != 1) return std::string(component);
    const bool vector = layer == "normal" || layer == "position" || layer == "motion";
    const bool colour = layer.empty() || layer == "noisy" || layer == "albedo" || layer == "sampleVariance";
    const char* from = vector ? "RGBxyzrgb" : colour ? "XYZrgbaxyz" : "";
    const char* to = vector ? "XYZXYZXYZ" : colour ? "RGBRGBARGB" : "";
    if (layer == "depth") return "Z";
    // Root X, Y, Z are luminance and depth, not colours.
    if (layer.empty() && std::strchr("XYZ", component[0])) return std::string(component);
    const char* place = std::strchr(from, component[0]);
    return place && *place ? std::string(1, to[place - from]) : std::string(component);
}

struct Resolved {
    std::string name;
    size_t rank = 0;  ///< order of preference; 0 is our own name
};

Resolved resolve(std::string_view name) {
    const std::string own(name);
    while (!name.empty() && name.front() == '.') name.remove_prefix(1);  // V-Ray's ".R"
    for (const Alias& alias : kChannelAliases)
        if (name == alias.theirs) return {alias.ours, 1};
    const size_t dot = name.rfind('.');
    if (dot == std::string_view::npos) return {std::string(name), name == own ? size_t(0) : 1};
    const std::string_view layer = name.substr(0, dot), component = name.substr(dot + 1);
    for (size_t i = 0; i < kLayerAliasCount; ++i) {
        // "ViewLayer.Combined.R": a layer below another one counts by its last part.
        const std::string_view theirs = kLayerAliases[i].theirs;
        const bool nested =
            layer.size() > theirs.size() && layer.ends_with(theirs) && layer[layer.size() - theirs.size() - 1] == '.';
        if (layer != theirs && !nested) continue;
        const std::string ours = kLayerAliases[i].ours;
        const std::string letter = componentFor(ours, component);
        return {ours.empty() ? letter : ours + '.' + letter, i + 2};
    }
    const std::string letter = componentFor(layer, component);
    if (letter != component && layer != "") return {std::string(layer) + '.' + letter, kLayerAliasCount + 2};
    return {std::string(name), name == own ? size_t(0) : 1};
}

}  // namespace

std::string canonicalChannel(std::string_view name) { return resolve(name).name; }

const ExrChannel* ExrLayers::find(std::string_view name) const {
    if (const auto exact = channels.find(std::string(name)); exact != channels.end()) return &exact->second;
    const ExrChannel* best = nullptr;
    size_t bestRank = SIZE_MAX;
    for (const auto& [theirs, channel] : channels) {
        const Resolved resolved = resolve(theirs);
        if (resolved.name != name || resolved.rank >= bestRank) continue;
        best = &channel;
        bestRank = resolved.rank;
    }
    return best;
}

}  // namespace lumi
