#pragma once
#include <map>
#include <string>
#include <vector>

#include "ui/document_mirror.h"

namespace lumi {

/// A camera as it was, lens and projection and all: the `camera.*` parameters that counted, by id, as text. Neither
/// which camera of the scene it came from nor its jitter are part of it.
using CameraBookmark = std::map<std::string, std::string>;

CameraBookmark bookmarkOf(const DocumentMirror& document);

/// What is to be set so that the document has this camera; ids that it does not know are left out. Throws Error(Usage)
/// if a text is no value.
std::vector<std::pair<std::string, ParameterValue>> valuesOf(const CameraBookmark& bookmark,
                                                             const DocumentMirror& document);

/// Options that give the present camera on the command line: `--set camera.eye=1,2,3 --set camera.look-at=...`, and
/// whatever else differs from the scene's.
std::string cameraAsCommandLine(const DocumentMirror& document);

}  // namespace lumi
