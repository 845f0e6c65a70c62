#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace lumi::gltf {

/// A file's name as it is meant [RFC 3986].
std::string unescaped(std::string_view uri);

/// The base64 of a data URI: up to a '=', the end or a character that is none.
struct Base64 {
    size_t begin = 0, end = 0;
    bool hasChanged = false;   ///< the URI has been rewritten
    std::string badCharacter;  ///< that which ends it, with its place, for messages; or empty

    uint64_t byteCount() const { return (end - begin) * 3 / 4; }
};

/// Finds the base64 behind the comma of a data URI and makes it readable for tinygltf: what a URI may escape ("%2B")
/// stands for itself, white space is left out, as browsers do. Rewritten in place, and only where it has such.
Base64 plainBase64(std::string& uri);

/// The beginning of a long name or data URI, for messages.
std::string shortened(std::string_view uri);

}  // namespace lumi::gltf
