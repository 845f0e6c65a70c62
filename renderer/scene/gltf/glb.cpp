#include "scene/gltf/glb.h"

#include <algorithm>
#include <cstring>

#include "base/error.h"

namespace lumi::gltf {
namespace {

constexpr size_t kHeader = 20;  ///< the file's and its first chunk's
constexpr uint32_t kJson = 0x4E4F534A, kBinary = 0x004E4942;

uint32_t word(std::span<const uint8_t> file, size_t offset) {
    uint32_t value = 0;
    std::memcpy(&value, file.data() + offset, 4);
    return value;
}

}  // namespace

bool isBinary(std::span<const uint8_t> file) { return file.size() >= 4 && std::memcmp(file.data(), "glTF", 4) == 0; }

std::string_view jsonChunk(std::span<const uint8_t> file, const std::string& where) {
    if (file.size() < kHeader)
        throwBadInput({.what = "the GLB is truncated",
                       .where = where,
                       .expected = "a header of 20 bytes",
                       .found = std::to_string(file.size()) + " bytes"});
    if (word(file, 4) != 2)
        throwBadInput({.what = "unsupported GLB version",
                       .where = where,
                       .expected = "2",
                       .found = std::to_string(word(file, 4))});
    if (word(file, 8) > file.size())
        throwBadInput({.what = "the GLB is truncated",
                       .where = where,
                       .expected = std::to_string(word(file, 8)) + " bytes",
                       .found = std::to_string(file.size())});
    const uint64_t length = word(file, 12);
    if (word(file, 16) != kJson || kHeader + length > file.size())
        throwBadInput({.what = "the GLB's JSON chunk is damaged", .where = where});
    return {reinterpret_cast<const char*>(file.data()) + kHeader, static_cast<size_t>(length)};
}

bool hasOtherChunk(std::span<const uint8_t> file) {
    const uint64_t header = uint64_t(kHeader) + word(file, 12);
    return header + 8 <= word(file, 8) && (word(file, header + 4) != kBinary || word(file, header) == 0);
}

uint64_t binaryChunkBytes(std::span<const uint8_t> file) {
    const uint64_t header = uint64_t(kHeader) + word(file, 12), begin = header + 8;
    if (begin > word(file, 8) || hasOtherChunk(file)) return 0;
    return std::min<uint64_t>(word(file, header), file.size() - begin);
}

std::vector<uint8_t> withJsonChunk(std::span<const uint8_t> file, std::string json) {
    json.resize((json.size() + 3) / 4 * 4, ' ');
    std::span<const uint8_t> rest;
    const std::span<const uint8_t> declared = file.first(word(file, 8));
    const size_t jsonEnd = kHeader + size_t(word(file, 12));
    if (!hasOtherChunk(file) && jsonEnd < declared.size()) rest = declared.subspan(jsonEnd);
    std::vector<uint8_t> out(kHeader + json.size() + rest.size());
    std::memcpy(out.data(), file.data(), kHeader);
    std::memcpy(out.data() + kHeader, json.data(), json.size());
    if (!rest.empty()) std::memcpy(out.data() + kHeader + json.size(), rest.data(), rest.size());
    const auto put = [&](size_t offset, size_t value) {
        const auto bits = static_cast<uint32_t>(value);
        std::memcpy(out.data() + offset, &bits, 4);
    };
    put(8, out.size());
    put(12, json.size());
    return out;
}

}  // namespace lumi::gltf
