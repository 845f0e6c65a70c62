#pragma once
#include <array>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "frame/display.h"
#include "params/parameter.h"
#include "reconstruct/module.h"
#include "scene/scene.h"
#include "scene/scene_choice.h"
#include "trace/settings.h"

namespace lumi {

/// What one view shows: `view.<n>.*`. Views 0 and 1 exist always; `view.layout` says how many are drawn.
struct ViewSettings {
    std::string module = "accumulate";  ///< instance name
    std::string buffer = "image";  ///< "image" (the module's result), a signal's name, or a tap's name of the module
    DisplaySettings display;
    void describe(ParameterVisitor&);
};
constexpr int kViewCount = 2;

/// How the views stand on the screen: `view.layout`. With Single only view 0 is drawn (and its module alone runs).
enum class Layout { Single, SideBySide, Wipe };

/// Frame settings: `render.*` in parameter ids.
struct RenderSettings {
    int width = 1280, height = 720;  ///< of the rendered image, independent of the window
    int samplesPerPixel = 1;         ///< per frame; id `spp`
    int seed = 0;
    float fps = 60;  ///< time advances by 1/fps a frame while it plays
    void describe(ParameterVisitor&);
};

/// All that a user can change, addressed by ids:
///     render.width  path.max-depth  sampler.kind  camera.eye  camera.select  camera.jitter  time  scene.index
///     scene.variant  scene.animation  environment.rotate-deg  environment.file  material.<name>.roughness
///     light.<name>.power  view.layout  view.0.buffer  view.0.exposure  <instance>.<parameter>
/// Names of materials, lights and cameras are written as slugs: lower case, anything but letters and digits as `-`,
/// `-2`, `-3` after the second and third of the same slug.
/// A Document is a value: copying is cheap (scenes and meshes are shared). It knows nothing of threads.
class Document {
public:
    /// Of a scene as loaded; the scene's own render settings apply. Throws Error(BadInput) if those name unknown ids.
    explicit Document(std::shared_ptr<const Scene> scene);

    std::shared_ptr<const Scene> scene() const { return edited_; }        ///< edits of materials, lights, sky applied
    std::shared_ptr<const Scene> loadedScene() const { return loaded_; }  ///< as loaded
    Camera camera() const { return cameraAt(time_); }  ///< at the document's time, the user's edits applied
    Camera cameraAt(float time) const;
    /// The camera from the opening of its shutter to the closing; empty if it stands still meanwhile.
    CameraTrack cameraTrack() const;
    int cameraIndex() const { return camera_; }
    Jitter jitter() const { return jitter_; }  ///< Auto: what the first view's module prefers
    float time() const { return time_; }
    Layout layout() const { return layout_; }
    float sceneRadius() const { return sceneRadius_; }  ///< half the diagonal of the scene at rest, metres
    const RenderSettings& render() const { return render_; }
    const PathSettings& path() const { return path_; }
    const ViewSettings& view(int index) const { return views_[static_cast<size_t>(index)]; }
    const SceneChoice& sceneChoice() const { return sceneChoice_; }

    /// Instances whose views are drawn, each once, in order of the views.
    std::vector<std::string> activeInstances() const;
    /// Gives a module the parameters that `instance` has.
    void configure(const std::string& instance, Module& module) const;

    /// Sets one value, and returns what that invalidates. Throws Error(Usage) naming the nearest id. `environment.file`
    /// reads the image (Error(BadInput) if it cannot); `camera.select` drops the user's camera edits; what begins with
    /// `scene.` only takes effect by loading again.
    Redo set(const std::string& id, const ParameterValue& value, const std::string& where = "");
    Redo setText(const std::string& id, const std::string& text, const std::string& where = "");
    /// Takes values back to what they were before any change, and returns what that invalidates: a camera's follow its
    /// animation again, `environment.file` brings the scene's own sky. Throws Error(Usage) for an unknown id.
    Redo reset(std::vector<std::string> ids);
    /// Takes the sky image of another document of the same scene, and leaves its scale and rotation.
    void adoptSkyImage(const Document& other);
    /// Content digest of the image that `environment.file` read; empty while the sky is the scene's own.
    const std::string& environmentDigest() const { return environmentDigest_; }
    void setTime(float seconds) { time_ = seconds; }
    ParameterValue get(const std::string& id) const;
    ParameterValue initial(const std::string& id) const;  ///< before any change: what "reset" goes back to
    /// Which ids: those of materials, lights and the sky, whose values are the same while scene() is; or the others.
    enum class Part { All, OfScene, Others };
    /// Every id with its declaration and present value. `group` filters by prefix ("path.", "svgf@b.").
    std::vector<ParameterInfo> list(const std::string& group = "", Part part = Part::All) const;
    /// Those of the sky, and of materials and lights that are not as in `other`, an edit of the same loaded scene.
    std::vector<ParameterInfo> listUnlike(const Scene& other) const;
    /// Values that differ from the scene's own defaults, as {"id": value}; applying them to a fresh Document of the
    /// same scene gives this one.
    nlohmann::json changedValues() const;
    /// What turns `from` into `to`, two documents of one scene, in the same form.
    static nlohmann::json difference(const Document& from, const Document& to);
    /// Sets every value of {"id": value}, in an order in which none undoes another. A relative `environment.file` that
    /// is not there is looked for beside the file `where`. With kEnvironmentDigest among the values, Error(BadInput) if
    /// the sky's image has another content.
    void apply(const nlohmann::json& values, const std::string& where = "");

    /// Beside `environment.file` in a state: environmentDigest(). No parameter.
    static constexpr const char* kEnvironmentDigest = "environment.digest";

private:
    friend class DocumentFields;
    Redo resetOne(const std::string& id);
    /// Does the camera move by itself, so that an edit to its present value fixes it?
    bool cameraMoves() const;
    static void addInstancesOf(const Document& from, const Document& to, nlohmann::json& changes);

    struct Names {
        std::vector<std::string> materials, lights, cameras;
    };
    using Values = std::map<std::string, ParameterValue>;

    std::shared_ptr<const Scene> loaded_, edited_;
    std::shared_ptr<const Names> names_;
    std::shared_ptr<const Document> initial_;  ///< null in the initial document itself
    RenderSettings render_;
    PathSettings path_;
    Jitter jitter_ = Jitter::Auto;
    Layout layout_ = Layout::Single;
    std::array<ViewSettings, kViewCount> views_;
    int camera_ = 0;
    Values cameraEdits_;  ///< by id without `camera.`
    float time_ = 0;
    float sceneRadius_ = 0;
    SceneChoice sceneChoice_;
    std::string environmentDigest_;
    std::map<std::string, Values> instances_;  ///< what was set, by instance
};

/// The ids' form of names: see Document. Unnamed things are called `<kind>-<number>`, counted from 1.
std::vector<std::string> slugs(const std::vector<std::string>& names, const std::string& kind);

}  // namespace lumi
