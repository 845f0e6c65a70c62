#pragma once
#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "base/messages.h"
#include "scene/scene.h"
#include "scene/scene_choice.h"

namespace lumi {

class ParameterVisitor;

/// How far a load has come; called from any thread, `fraction` in [0,1], `step` names what is being done.
using LoadProgress = std::function<void(float fraction, const std::string& step)>;

/// How an OBJ is subdivided.
enum class SubdivisionScheme { Auto, None, CatmullClark, Bilinear };
struct Subdivision {
    SubdivisionScheme scheme = SubdivisionScheme::Auto;  ///< Auto: what the file says
    int rate = 8;                                        ///< segments along every edge of the cage
    void describe(ParameterVisitor& v);
};

struct LoadOptions {
    SceneChoice choice;       ///< glTF
    Subdivision subdivision;  ///< OBJ
    LoadProgress progress;
    std::stop_token stop;  ///< a stopped load throws Error(Interrupted)
};

/// Loads .json (our own), .gltf, .glb, .obj; an .hdr or .exr gives a material ball under that sky. A scene without a
/// camera gets `default`, one without light or emission the built-in sky and a warning (not for .json); see README.
/// Warnings go to `log`. Throws Error(BadInput) with file and position, Error(Resources), or Error(Usage) for a
/// choice that the file does not offer.
std::shared_ptr<const Scene> loadScene(const std::filesystem::path& path, MessageLog& log,
                                       const LoadOptions& options = {});

/// Where a scene named on the command line is: the path itself if it exists, else `<name>.json` in each folder of
/// $LUMISCOPE_SCENES, beside the program, and in the source tree. Throws Error(Usage) with the nearest built-in name if
/// `name` has no extension, else Error(BadInput) "no such file".
std::filesystem::path findScene(const std::string& name);

/// The built-in scenes: name, title, path; in the order of the README.
struct SceneEntry {
    std::string name, title;
    std::filesystem::path path;
    std::string missing;  ///< says which asset of its is not there (scene/asset_folder.h); empty: all are
};
std::vector<SceneEntry> listScenes();

}  // namespace lumi
