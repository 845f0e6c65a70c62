#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ui/commands.h"
#include "ui/panels/panels.h"
#include "ui/widgets.h"

namespace lumi {

namespace {

constexpr int kTargets[] = {256, 1024, 4096, 16384};
/// Measured with every frame; the others take longer and are asked for.
constexpr const char* kQuick[] = {"rmse", "relmse", "psnr", "smape", "ssim"};

std::string valueText(const PaneMeasurement& pane, const std::string& id) {
    const auto value = pane.values.find(id);
    if (value == pane.values.end()) return "-";
    return std::isfinite(value->second) ? fmt::format("{:.5g}", value->second) : value->second > 0 ? "inf" : "-";
}

void drawProgress(AppState& state, const ReferenceStatus& status) {
    const ReferenceProgress& progress = status.progress;
    const float width = ImGui::GetContentRegionAvail().x;
    const float fraction =
        progress.target > 0 ? static_cast<float>(progress.samples) / static_cast<float>(progress.target) : -1;
    progressBar(fraction, width, px(6));
    const std::string text = progress.waiting ? "Another process makes the same reference; waiting for it"
                             : progress.target > 0
                                 ? fmt::format("{} of {} samples a pixel", progress.samples, progress.target)
                                 : "Preparing";
    smallText(text);
    if (textButton("cancel-reference", "Stop")) state.metrics.cancelReference();
    if (ImGui::IsItemHovered()) tooltip("Stop", "What is done so far is kept: it goes on from there the next time.");
}

void drawReference(AppState& state) {
    const ReferenceStatus status = state.metrics.reference();
    if (status.present) {
        ImGui::TextUnformatted(shortened(status.name, ImGui::GetContentRegionAvail().x).c_str());
        std::string facts = fmt::format("{} x {}", status.extent.width, status.extent.height);
        if (status.error > 0) facts += fmt::format(", own error {:.2g}", status.error);
        smallText(facts);
    } else if (!status.working) {
        ImGui::PushTextWrapPos(0);
        dimText("Metrics compare each view with a converged image of the same thing.");
        ImGui::PopTextWrapPos();
    }
    if (status.working) return drawProgress(state, status);

    smallText("Samples a pixel");
    const int clicked = segments("reference-samples", {"256", "1024", "4096", "16384"}, state.referenceTarget);
    if (clicked >= 0) state.referenceTarget = clicked;
    const float half = std::floor(0.5f * (ImGui::GetContentRegionAvail().x - px(8)));
    if (textButton("make-reference", status.present ? "Make again" : "Make reference", nullptr, !status.present, half))
        runCommand(state, UiCommand::MakeReference);
    if (ImGui::IsItemHovered())
        tooltip("Converges what is shown now",
                "From the cache of references, or traced and kept there. Rendering pauses meanwhile.",
                shortcutText(UiCommand::MakeReference));
    if (status.present) {
        ImGui::SameLine(0, px(8));
        if (textButton("clear-reference", "Clear", nullptr, false, half)) state.metrics.clearReference();
    }
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - px(72));
    const bool entered = ImGui::InputTextWithHint("##reference-file", "or an image file: .exr .hdr .png",
                                                  &state.referenceFile, ImGuiInputTextFlags_EnterReturnsTrue);
    markItem("reference-file");
    ImGui::SameLine(0, px(8));
    if ((textButton("load-reference", "Load", nullptr, false, px(64)) || entered) && !state.referenceFile.empty())
        state.metrics.loadReference(state.referenceFile);
}

/// A table of metrics and panes; of two panes the better value is bright.
void drawValues(AppState& state, const LiveMeasurement& measured) {
    const bool two = measured.panes.size() > 1;
    if (!ImGui::BeginTable("metrics", two ? 3 : 2, ImGuiTableFlags_RowBg)) return;
    ImGui::TableSetupColumn("metric", ImGuiTableColumnFlags_WidthFixed, px(86));
    for (size_t pane = 0; pane < measured.panes.size(); ++pane)
        ImGui::TableSetupColumn(pane == 0 ? "A" : "B", ImGuiTableColumnFlags_WidthStretch);
    if (two) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        for (const PaneMeasurement& pane : measured.panes) {
            ImGui::TableNextColumn();
            smallText(shortened((&pane == &measured.panes[0] ? "A  " : "B  ") + pane.module,
                                ImGui::GetContentRegionAvail().x));
        }
    }
    for (const Metric& metric : metricCatalog()) {
        if (!measured.panes.empty() && !measured.panes[0].values.count(metric.id)) continue;
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        {
            const WithFont small(ui().fonts.small);
            dimText(metric.id);
        }
        if (ImGui::IsItemHovered()) tooltip(metric.title, metric.definition);
        for (size_t i = 0; i < measured.panes.size(); ++i) {
            ImGui::TableNextColumn();
            const PaneMeasurement &pane = measured.panes[i], &other = measured.panes[two ? 1 - i : i];
            const auto mine = pane.values.find(metric.id), its = other.values.find(metric.id);
            const bool better = two && mine != pane.values.end() && its != other.values.end() &&
                                (metric.higherIsBetter ? mine->second > its->second : mine->second < its->second);
            const WithFont mono(ui().fonts.mono);
            ImGui::TextColored(toVec4(better ? palette::kGood : palette::kText), "%s",
                               valueText(pane, metric.id).c_str());
            if (const auto reason = pane.reasons.find(metric.id);
                reason != pane.reasons.end() && ImGui::IsItemHovered())
                tooltip(metric.title, reason->second);
            markItem(fmt::format("metric:{}:{}", metric.id, i));
        }
    }
    ImGui::EndTable();
    for (const PaneMeasurement& pane : measured.panes)
        if (pane.nonFinitePixels > 0)
            smallText(fmt::format("{}: {} pixels not finite, counted nowhere", pane.module, pane.nonFinitePixels),
                      palette::kWarning);
    const std::string of =
        measured.samples > 0 ? fmt::format("{} spp", measured.samples) : fmt::format("frame {}", measured.frame);
    smallText(fmt::format("of {}, measured in {:.0f} ms", of, measured.ms), palette::kFaint);
    markItem("measured-of:" + of);
}

/// The metric of the map, or RMSE, over samples on logarithmic axes.
void drawCurves(const AppState& state) {
    const std::string id = state.errorMap.empty() ? "rmse" : state.errorMap;
    const std::shared_ptr<const ConvergenceCurves> noted = state.metrics.curves();
    static const ConvergenceCurves kNone;
    const ConvergenceCurves& curves = noted ? *noted : kNone;
    double lowX = 1e300, highX = -1e300, lowY = 1e300, highY = -1e300;
    const auto usable = [&](const ConvergencePoint& p) {
        const auto v = p.values.find(id);
        return p.samples > 0 && v != p.values.end() && std::isfinite(v->second) && v->second > 0;
    };
    for (const auto& curve : curves)
        for (const ConvergencePoint& p : curve) {
            if (!usable(p)) continue;
            const double x = std::log10(static_cast<double>(p.samples)), y = std::log10(p.values.at(id));
            lowX = std::min(lowX, x), highX = std::max(highX, x), lowY = std::min(lowY, y), highY = std::max(highY, y);
        }
    if (highX <= lowX) {
        const bool accumulates = state.snapshot && state.snapshot->accumulatedSamples > 0;
        return smallText(accumulates ? "The curve begins with the second measurement."
                                     : "A curve over samples is of modules that accumulate them.",
                         palette::kFaint);
    }
    if (highY - lowY < 0.3) lowY -= 0.15, highY += 0.15;
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x, height = px(96);
    ImGui::Dummy(ImVec2(width, height));
    markRect("convergence", corner, corner + ImVec2(width, height));
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(corner, corner + ImVec2(width, height), IM_COL32(18, 19, 21, 255), px(4));
    const auto at = [&](const ConvergencePoint& p) {
        const double x = (std::log10(static_cast<double>(p.samples)) - lowX) / (highX - lowX);
        const double y = (std::log10(p.values.at(id)) - lowY) / (highY - lowY);
        return ImVec2(corner.x + px(6) + static_cast<float>(x) * (width - px(12)),
                      corner.y + px(6) + static_cast<float>(1 - y) * (height - px(12)));
    };
    for (size_t i = 0; i < curves.size(); ++i) {
        for (const ConvergencePoint& p : curves[i])
            if (usable(p)) list.PathLineTo(at(p));
        list.PathStroke(i == 0 ? palette::kAccent : palette::kWarning, 0, px(1.5f));
    }
    smallText(fmt::format("{} from {:.0f} to {:.0f} samples, {:.3g} to {:.3g}", id, std::pow(10, lowX),
                          std::pow(10, highX), std::pow(10, highY), std::pow(10, lowY)),
              palette::kFaint);
}

void drawMapChoice(AppState& state) {
    dimText("Error map");
    ImGui::SameLine(std::floor(kLabelShare * ImGui::GetContentRegionAvail().x) + px(16));
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - px(24));
    if (!ImGui::BeginCombo("##error-map", state.errorMap.empty() ? "off" : state.errorMap.c_str())) {
        markItem("error-map");
        return;
    }
    markItem("error-map");
    if (ImGui::Selectable("off", state.errorMap.empty())) state.errorMap.clear();
    markItem("error-map:off");
    for (const Metric& metric : metricCatalog()) {
        if (!metric.mapColours) continue;
        if (ImGui::Selectable(metric.id, state.errorMap == metric.id)) state.errorMap = metric.id;
        markItem(std::string("error-map:") + metric.id);
    }
    ImGui::EndCombo();
}

}  // namespace

std::vector<std::string> wantedMetrics(const AppState& state) {
    if (!state.allMetrics) return {std::begin(kQuick), std::end(kQuick)};
    std::vector<std::string> ids;
    for (const Metric& metric : metricCatalog()) ids.emplace_back(metric.id);
    return ids;
}

uint64_t referenceSamples(const AppState& state) { return static_cast<uint64_t>(kTargets[state.referenceTarget]); }

void drawMeasurePanel(AppState& state) {
    if (section("Reference")) drawReference(state);
    if (!state.metrics.reference().present) return;
    if (section("Against the reference")) {
        drawMapChoice(state);
        bool all = state.allMetrics;
        dimText("All metrics");
        ImGui::SameLine(std::floor(kLabelShare * ImGui::GetContentRegionAvail().x) + px(16));
        if (toggleSwitch("all-metrics", all)) state.allMetrics = all;
        markItem("all-metrics");
        const auto measured = state.metrics.latest();
        if (!measured) smallText("Measuring ...");
        else if (!measured->problem.empty()) {
            ImGui::PushTextWrapPos(0);
            smallText(measured->problem, palette::kWarning);
            ImGui::PopTextWrapPos();
        } else drawValues(state, *measured);
    }
    if (section("Convergence")) drawCurves(state);
}

}  // namespace lumi
