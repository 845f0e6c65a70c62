#include "app/workbench.h"

#include <future>

#include "image/png.h"

namespace lumi {

void openAtStart(Session& session, AppState& state, const StartOptions& start) {
    if (start.scene.empty()) return;
    std::vector<std::pair<std::string, std::string>> set;
    for (size_t pane = 0; pane < start.modules.size() && pane < static_cast<size_t>(kViewCount); ++pane)
        set.emplace_back(state.viewId(static_cast<int>(pane), "module"), start.modules[pane]);
    if (start.modules.size() > 1) set.emplace_back("view.layout", "side-by-side");
    set.insert(set.end(), start.set.begin(), start.set.end());
    session.open(start.scene, start.sceneIndex, start.variant, std::move(set));
}

void PictureWriter::write(Image8 picture, const std::filesystem::path& path) {
    std::erase_if(pending_, [](const std::future<void>& f) {
        return f.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    });
    pending_.push_back(std::async(std::launch::async, [this, path, image = std::move(picture)] {
        try {
            writePng(path, image);
            log_.info("Saved " + path.string());
        } catch (const std::exception& error) {
            log_.error(error.what());
        }
    }));
}

}  // namespace lumi
