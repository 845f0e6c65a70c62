#include <fmt/format.h>

#include <set>

#include "reconstruct/catalog.h"
#include "ui/panels/panels.h"
#include "ui/parameter_widgets.h"
#include "ui/widgets.h"

namespace lumi {

namespace {

struct Group {
    const char* title;
    const char* prefix;
};
constexpr Group kGroups[] = {{"Image", "render."}, {"Path tracing", "path."}, {"Sampling", "sampler."}};

/// A section over a group of parameters; nothing, and false, if no row answers the search.
bool drawGroup(AppState& state, const char* title, const std::string& prefix) {
    const std::string& search = state.parameterSearch;
    bool any = false;
    for (const ParameterInfo* info : state.document.group(prefix))
        any = any || (info->active && (search.empty() || matches(search, info->label) || matches(search, info->id)));
    if (!any) return false;
    ImGui::PushID(prefix.c_str());
    if (section(title)) parameterRows(state, prefix, search);
    ImGui::PopID();
    return true;
}

/// Ends that are often wanted, for the module that accumulates.
void drawTargetButtons(AppState& state) {
    std::string instance;
    for (int pane = 0; pane < state.paneCount() && instance.empty(); ++pane)
        if (state.document.find(state.module(pane) + ".max-samples")) instance = state.module(pane);
    if (instance.empty()) return;
    constexpr int kTargets[] = {64, 256, 1024, 4096};
    const bool limited =
        state.document.text(instance + ".limit") == "true" || state.document.text(instance + ".limit") == "on";
    int chosen = 0;
    for (int i = 0; i < 4; ++i)
        if (limited && state.document.number(instance + ".max-samples", 0) == static_cast<float>(kTargets[i]))
            chosen = i + 1;
    const int clicked = segments("target", {"No end", "64", "256", "1024", "4096"}, chosen);
    if (clicked < 0) return;
    std::vector<std::pair<std::string, ParameterValue>> values{{instance + ".limit", clicked > 0}};
    if (clicked > 0) values.emplace_back(instance + ".max-samples", kTargets[clicked - 1]);
    state.session.setAll(values);
    state.session.endEdit();
}

/// Progress to the number of samples a user asked for.
void drawTarget(AppState& state) {
    if (!state.snapshot || !section("Progress")) return;
    const Snapshot& now = *state.snapshot;
    const auto samples = static_cast<double>(now.accumulatedSamples), target = static_cast<double>(now.targetSamples);
    if (target > 0) {
        const auto fraction = static_cast<float>(samples / target);
        progressBar(fraction, ImGui::GetContentRegionAvail().x, px(6),
                    fraction >= 1 ? palette::kGood : palette::kAccent);
        const double perFrame = std::max(1.0f, state.document.number("render.spp", 1));
        const double seconds = std::max(0.0, target - samples) / perFrame * now.frameMs * 1e-3;
        smallText(fraction >= 1
                      ? fmt::format("{:.0f} samples per pixel: done", samples)
                      : fmt::format("{:.0f} of {:.0f} samples per pixel, {:.0f} s to go", samples, target, seconds));
    } else {
        smallText(now.accumulatedSamples ? fmt::format("{:.0f} samples per pixel, no end set", samples)
                                         : fmt::format("Frame {}", now.frame));
    }
    drawTargetButtons(state);
}

}  // namespace

void drawRenderPanel(AppState& state) {
    searchField("parameter-search", state.parameterSearch, "Search parameters");
    if (state.parameterSearch.empty()) drawTarget(state);
    std::set<std::string> drawn;
    bool any = false;
    for (int pane = 0; pane < state.paneCount(); ++pane) {
        const std::string instance = state.module(pane);
        if (!drawn.insert(instance).second || !state.document.hasGroup(instance + ".")) continue;
        const std::string title =
            std::string(findModule(instance).title) + (instance.find('@') == std::string::npos ? "" : "  " + instance);
        any |= drawGroup(state, title.c_str(), instance + ".");
    }
    for (const Group& group : kGroups) any |= drawGroup(state, group.title, group.prefix);
    if (!any) dimText("No parameter here has that in its name.");
}

}  // namespace lumi
