#pragma once
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

namespace lumi::gltf {

/// What a rule wants at its place.
enum class Kind {
    Object,
    Array,
    Text,
    Number,
    Numbers,  ///< an array of `most` of them
    Whole,    ///< from `least` to `most`, a multiple of `step`
    Code,     ///< a whole number among the words of `of`
    Word,     ///< a text among the words of `of`
    Index,    ///< into the section `of`, which may be a path
    Texture,  ///< an object; with an index of -1 or null, it is absent as a whole
    Typed,    ///< an object whose "type", if it is among `of`, names the member that must be there; the others go
};
enum class Need { Optional, Required };

constexpr uint64_t kAny = std::numeric_limits<uint64_t>::max();
constexpr uint64_t kMostInt = std::numeric_limits<int>::max();  ///< of what tinygltf keeps as an int

/// What stands at a path, which is a pattern of JsonWalk. What is on the way to it is optional, but of the right type.
/// Null is read as absent where a rule is optional.
struct Rule {
    std::string_view path;
    Kind kind;
    std::string_view of = {};  ///< words with '|' between, or a section
    Need need = Need::Optional;
    uint64_t least = 0, most = kAny, step = 1;
    bool orMinusOne = false;  ///< -1 is read as absent, too; so it is of optional indices
};

/// Of where the version stands; of what later rules rely on, that sections hold objects of known types; and the rest.
std::span<const Rule> assetRules();
std::span<const Rule> formRules();
std::span<const Rule> rules();

/// The textures of a material, as paths in it: those that are read.
std::span<const std::string_view> texturePaths();
/// Of each of them, as ends of its path: that of the texture itself is "".
std::span<const Rule> textureRules();

}  // namespace lumi::gltf
