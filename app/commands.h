#pragma once
#include <memory>
#include <optional>
#include <stop_token>

#include "app/cli.h"
#include "base/messages.h"
#include "scene/camera_path.h"
#include "scene/load.h"
#include "session/document.h"

namespace lumi {

// Each command returns the program's exit code and throws Error; results go to standard output, all else to standard
// error.
int runRender(const RenderOptions& options, const MachineOptions& machine, MessageLog& log, std::stop_token stop);
/// With `check` the signals' contract is verified too; 1 if a rule is broken. The camera's keys go to
/// `writeCameraPath`, if that is not empty.
int runInfo(const SceneOptions& options, bool check, const std::filesystem::path& writeCameraPath,
            const MachineOptions& machine, MessageLog& log, std::stop_token stop);
int runList(const ListOptions& options, const MachineOptions& machine);

/// Throws Error(Resources) if something of the results did not reach standard output, as on a full disk.
void requireWholeOutput();

/// Threads, instruction set and memory limit, before anything is computed.
void applyMachine(const MachineOptions& machine);

/// Prints what has been reported on standard error, and from now on what is. A scene that fails to load is one line, so
/// this is for those that loaded.
void printMessages(MessageLog& log, const MachineOptions& machine);

/// The scene that the options name, with the `scene.` values among theirs.
std::shared_ptr<const Scene> openScene(const std::filesystem::path& file, const SceneOptions& options, MessageLog& log,
                                       std::stop_token stop);

/// Puts the camera where it is at the document's time; nothing without a path.
void followCameraPath(Document& document, const std::optional<CameraPath>& path);
std::optional<CameraPath> readCameraPathOf(const SceneOptions& options);

/// A document of the scene with all values of the options. A --set of a method's parameter counts for that one
/// instance: where it is none of those that run, the log warns.
Document makeDocument(std::shared_ptr<const Scene> scene, const SceneOptions& options, MessageLog& log);

}  // namespace lumi
