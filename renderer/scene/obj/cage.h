#pragma once
#include <tiny_obj_loader.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/file_warnings.h"
#include "scene/subdivision.h"

namespace lumi {

/// `#t` at the beginning of a line becomes ` t` before a tag that is known: files that keep OpenSubdiv's as comments.
void uncommentTags(std::string& objText);

/// The scheme of a subdivision surface that the file says to be the cage of, by a comment "# scheme: catmark" or
/// "# scheme: bilinear", as OpenSubdiv's shapes do.
std::optional<SubdivisionCage::Scheme> saidScheme(std::string_view objText, FileWarnings& warnings);

/// True if a shape has a tag that is known: the file means a subdivision surface.
bool hasTags(const std::vector<tinyobj::shape_t>& shapes);

/// Warns, once for each name, of tags that nothing is made of.
void warnOfOtherTags(const std::vector<tinyobj::shape_t>& shapes, FileWarnings& warnings);

/// All shapes of an OBJ as one subdivision cage: faces as they are, with OpenSubdiv's `t` tag lines (crease, corner,
/// hole, interpolateboundary, facevaryinginterpolateboundary, creasemethod, smoothtriangles). Other tags are warnings;
/// so are hierarchical edits, which are left out. Texture coordinates as in our meshes, v from the top. Materials by
/// tinyobj's numbers; faces without one get `fallbackMaterial`. Throws Error(BadInput) headed by the file.
SubdivisionCage cageOf(const tinyobj::attrib_t& attributes, const std::vector<tinyobj::shape_t>& shapes,
                       SubdivisionCage::Scheme scheme, uint32_t fallbackMaterial, FileWarnings& warnings);

/// The same from text, without materials.
SubdivisionCage parseCage(std::string objText, const std::string& where, MessageLog& log);

}  // namespace lumi
