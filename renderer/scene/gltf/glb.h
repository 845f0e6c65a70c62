#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lumi::gltf {

/// True if the file begins like a GLB.
bool isBinary(std::span<const uint8_t> file);

/// The JSON chunk of a GLB. Throws Error(BadInput) headed by `where` if the header or the chunk is cut off.
std::string_view jsonChunk(std::span<const uint8_t> file, const std::string& where);

/// Of a GLB that jsonChunk() accepts: is what follows its JSON a binary chunk without bytes, or one of another kind?
/// tinygltf refuses both, while glTF asks to pass over unknown chunks.
bool hasOtherChunk(std::span<const uint8_t> file);

/// Bytes of the binary chunk of a GLB that jsonChunk() accepts, which directly follows its JSON; 0 without one.
uint64_t binaryChunkBytes(std::span<const uint8_t> file);

/// A GLB that jsonChunk() accepts, with another JSON chunk and without other chunks.
std::vector<uint8_t> withJsonChunk(std::span<const uint8_t> file, std::string json);

}  // namespace lumi::gltf
