#pragma once
#include <string>

#include "scene/file_warnings.h"

namespace lumi {

/// Looks at every `v`, `vt`, `vn`, `f`, `l` and `p` line of an OBJ file's text, since tinyobj reads what is no number
/// as 0, and blanks what it would misread: comments behind the numbers, and texture coordinates and normals of faces
/// that are empty or not there. Throws Error(BadInput) headed by the file and the line for a position with fewer than
/// three numbers or with something that is no finite number, and for a face that refers to what is not there
/// (FaceCheck); texture coordinates and normals that are no numbers are one warning, and read as 0.
void checkObjNumbers(std::string& text, FileWarnings& warnings);

}  // namespace lumi
