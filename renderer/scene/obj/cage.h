#pragma once
#include <filesystem>
#include <string>

#include "scene/subdivision.h"

namespace lumi {

/// Reads an OBJ as a subdivision cage: faces as they are, with OpenSubdiv's `t` tag lines (crease, corner, hole,
/// interpolateboundary, facevaryinginterpolateboundary, creasemethod, smoothtriangles); `#t` lines count as tags too.
/// Hierarchical edits are ignored. Several shapes become one cage. Throws Error(BadInput).
SubdivisionCage loadCage(const std::filesystem::path& path);
SubdivisionCage parseCage(std::string objText, const std::string& where);

}  // namespace lumi
