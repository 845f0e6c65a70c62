#include "app/workbench.h"

#include <algorithm>

namespace lumi {

void openAtStart(Session& session, AppState& state, const StartOptions& start) {
    if (start.scene.empty()) return;
    std::vector<std::pair<std::string, std::string>> set;
    for (size_t pane = 0; pane < start.modules.size() && pane < static_cast<size_t>(kViewCount); ++pane)
        set.emplace_back(state.viewId(static_cast<int>(pane), "module"), start.modules[pane]);
    if (start.modules.size() > 1) set.emplace_back("view.layout", "side-by-side");
    for (const TypedValue& value : start.set) set.emplace_back(value.id, value.text);
    session.open(start.scene, start.choice, std::move(set));
}

void StartCheck::check() {
    if (done_ || session_.loadStatus().loading) return;
    done_ = true;
    if (!session_.hasScene()) return;
    const std::vector<Message> messages = log_.messages();
    const auto isError = [](const Message& message) { return message.severity == Severity::Error; };
    if (std::none_of(messages.begin(), messages.end(), isError)) return;
    Document document(session_.document().loadedScene());
    for (const TypedValue& value : values_) document.setText(value.id, value.text, value.option);
}

}  // namespace lumi
