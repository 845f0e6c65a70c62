#pragma once
#include "scene/load.h"

namespace lumi {

/// Loads a Wavefront .obj with its .mtl files: an instance for each object or group, polygons triangulated by ear
/// clipping, vertices shared where position, texture coordinate and normal are. Corners without normals are smooth
/// within their smoothing group and flat outside of any. A file with OpenSubdiv's tags, or any if `options` say so, is
/// the cage of one Catmull-Clark surface instead. Missing material files and images are warnings. Throws
/// Error(BadInput) headed by the file's name, Error(Resources), Error(Interrupted).
Scene loadObj(const std::filesystem::path& path, MessageLog& log, const LoadOptions& options = {});

}  // namespace lumi
