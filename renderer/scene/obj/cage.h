#pragma once
#include <filesystem>
#include <string>

#include "base/messages.h"
#include "scene/subdivision.h"

namespace lumi {

/// Reads an OBJ as a subdivision cage: faces as they are, with OpenSubdiv's `t` tag lines (crease, corner, hole,
/// interpolateboundary, facevaryinginterpolateboundary, creasemethod, smoothtriangles); `#t` lines count as tags too.
/// Hierarchical edits are ignored. Several shapes become one cage. Throws Error(BadInput).
SubdivisionCage loadCage(const std::filesystem::path& path, MessageLog& log);
SubdivisionCage parseCage(std::string objText, const std::string& where, MessageLog& log);

}  // namespace lumi
