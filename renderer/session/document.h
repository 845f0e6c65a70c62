#pragma once
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "frame/display.h"
#include "params/parameter.h"
#include "reconstruct/module.h"
#include "scene/scene.h"

namespace lumi {

/// What one view shows: `view.<n>.*`. Panes 0 and 1 exist always; the layout says how many are drawn.
struct ViewSettings {
    std::string module = "accumulate";  ///< instance name
    std::string buffer = "image";       ///< "image" (the module's result), a signal's name, or a tap's name of the module
    DisplaySettings display;
    void describe(ParameterVisitor&);
};

/// Frame settings: `render.*` in parameter ids.
struct RenderSettings {
    int width = 640, height = 360;   ///< of the rendered image, independent of the window
    int samplesPerPixel = 1;         ///< per frame
    int seed = 0;
    Jitter jitter = Jitter::Auto;    ///< Auto: what the first view's module prefers
    int maxSamples = 0;              ///< 0 cannot be set from a panel: see `limit`
    void describe(ParameterVisitor&);
};

/// All that a user can change, addressed by ids:
///     render.width  path.max-depth  sampler...  camera.eye  camera.select  time  scene.variant  environment.rotate-deg
///     material.<name>.roughness  light.<name>.power  view.0.buffer  view.0.exposure  <instance>.<parameter>
/// A Document is a value: copying is cheap (scenes and meshes are shared). It knows nothing of threads.
class Document {
public:
    explicit Document(std::shared_ptr<const Scene> scene);

    std::shared_ptr<const Scene> scene() const;  ///< with the edits to materials, lights and environment applied
    Camera camera() const;                        ///< at the document's time, user's edits applied
    /// Sets one value, and returns what that invalidates. Throws Error(Usage) naming the nearest id.
    Redo set(const std::string& id, const ParameterValue& value, const std::string& where = "");
    Redo setText(const std::string& id, const std::string& text, const std::string& where = "");
    ParameterValue get(const std::string& id) const;
    ParameterValue initial(const std::string& id) const;  ///< before any change: what "reset" goes back to
    /// Every id with its declaration and present value. `group` filters by prefix ("path.", "svgf@b.").
    std::vector<ParameterInfo> list(const std::string& group = "") const;
    /// Values that differ from the scene's own defaults, as {"id": value}; applying them to a fresh Document of the
    /// same scene gives this one.
    nlohmann::json changedValues() const;
};

}  // namespace lumi
