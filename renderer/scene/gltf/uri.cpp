#include "scene/gltf/uri.h"

#include <fmt/format.h>

#include <array>
#include <charconv>

namespace lumi::gltf {
namespace {

constexpr std::array<bool, 256> kIsBase64 = [] {
    constexpr std::string_view kCharacters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::array<bool, 256> table{};
    for (const char c : kCharacters) table[static_cast<unsigned char>(c)] = true;
    return table;
}();

bool isBase64(char c) { return kIsBase64[static_cast<unsigned char>(c)]; }
bool isSpace(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

/// Reads one character, escaped or not, and moves on.
char nextCharacter(std::string_view uri, size_t& at) {
    const char* const hex = uri.data() + at + 1;
    unsigned char byte = 0;
    const bool escapes =
        uri[at] == '%' && at + 2 < uri.size() && std::from_chars(hex, hex + 2, byte, 16).ptr == hex + 2;
    at += escapes ? 3 : 1;
    return escapes ? static_cast<char>(byte) : uri[at - 1];
}

std::string shown(char c) {
    return c > ' ' && c <= '~' ? fmt::format("\"{}\"", c) : fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
}

}  // namespace

std::string unescaped(std::string_view uri) {
    std::string name;
    for (size_t at = 0; at < uri.size();) name += nextCharacter(uri, at);
    return name;
}

Base64 plainBase64(std::string& uri) {
    Base64 data;
    data.begin = data.end = uri.find(',') + 1;
    while (data.end < uri.size() && isBase64(uri[data.end])) ++data.end;
    for (size_t at = data.end; at < uri.size();) {
        const size_t from = at;
        const char c = nextCharacter(uri, at);
        if (isBase64(c)) {
            uri[data.end++] = c;
            data.hasChanged = true;
        } else if (!isSpace(c)) {
            if (c != '=') data.badCharacter = fmt::format("{} as its character {}", shown(c), from - data.begin + 1);
            break;
        }
    }
    if (data.hasChanged) uri.resize(data.end);
    return data;
}

std::string shortened(std::string_view uri) { return std::string(uri.substr(0, 40)) + (uri.size() > 40 ? "..." : ""); }

}  // namespace lumi::gltf
