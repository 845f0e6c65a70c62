#pragma once
#include <functional>
#include <string>
#include <string_view>

namespace lumi {

/// Text of an .obj in the form that tinyobj reads alike: without a byte order mark, continued lines whole (their other
/// lines stay empty, so that line feeds count the file's lines), and a `mtllib` line a file. `exists(name)` says
/// whether the .obj's folder holds a file: names may have spaces.
std::string plainObj(std::string_view text, const std::function<bool(const std::string&)>& exists);

/// The same of an .mtl: a colour of one number has all three [MTL: "r g b", g and b optional], `-o`, `-s` and `-t` of
/// textures have all three numbers, and `-cc`, which tinyobj takes for a file, is left out.
std::string plainMtl(std::string_view text);

}  // namespace lumi
