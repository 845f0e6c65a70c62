#pragma once
#include <cstdint>
#include <span>
#include <string>

namespace lumi {

/// Walks the segments of a JPEG as stb_image does, and throws Error(BadInput) headed by `name` for a Huffman table of
/// more than 256 codes, which version 2.27 writes past its arrays for. Anything but a JPEG passes.
void checkJpegTables(std::span<const uint8_t> bytes, const std::string& name);

}  // namespace lumi
