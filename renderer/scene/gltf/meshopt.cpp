#include "scene/gltf/meshopt.h"

#include <meshoptimizer.h>

#include "base/memory.h"
#include "scene/gltf/values.h"

namespace lumi::gltf {
namespace {

constexpr const char* kExtension = "EXT_meshopt_compression";

struct Compressed {
    std::span<const uint8_t> bytes;
    size_t stride = 0, count = 0;
    std::string mode, filter;
    size_t size() const { return stride * count; }
};

Compressed readExtension(const Document& document, const tinygltf::Value& extension, const std::string& path) {
    const auto number = [&](const char* key) { return static_cast<size_t>(integerOf(extension, key, 0)); };
    Compressed view;
    view.bytes =
        document.bufferBytes(integerOf(extension, "buffer", -1), number("byteOffset"), number("byteLength"), path);
    view.stride = number("byteStride");
    view.count = number("count");
    view.mode = textOf(extension, "mode");
    view.filter = extension.Has("filter") ? textOf(extension, "filter") : "NONE";
    return view;
}

/// The most elements that so many bytes can stand for: a triangle takes a byte at least; sixteen attribute bytes, all
/// equal to the ones before, take two bits.
size_t mostElements(const Compressed& view) {
    if (view.mode == "TRIANGLES") return 3 * view.bytes.size();
    if (view.mode == "INDICES") return view.bytes.size();
    return 64 * view.bytes.size() / view.stride + 64;
}

void checkLayout(const Document& document, const Compressed& view, size_t viewLength, const std::string& path) {
    const bool attributes = view.mode == "ATTRIBUTES";
    if (!attributes && view.mode != "TRIANGLES" && view.mode != "INDICES")
        document.fail(path + "/mode", "no such mode", "ATTRIBUTES, TRIANGLES or INDICES", view.mode.substr(0, 40));
    if (attributes ? view.stride % 4 != 0 : view.stride != 2 && view.stride != 4)
        document.fail(path + "/byteStride", "does not fit the mode",
                      attributes ? "a multiple of 4, at most 256" : "2 or 4", std::to_string(view.stride));
    if (view.mode == "TRIANGLES" && view.count % 3 != 0)
        document.fail(path + "/count", "is not a multiple of 3", {}, std::to_string(view.count));
    if (view.count > mostElements(view))
        document.fail(path + "/count", "is more than the compressed bytes can hold",
                      "at most " + std::to_string(mostElements(view)), std::to_string(view.count));
    if (view.size() != viewLength)
        document.fail(path, "count and byteStride do not fit the buffer view", std::to_string(viewLength) + " bytes",
                      std::to_string(view.size()));
}

void undoFilter(const Document& document, const Compressed& view, std::vector<uint8_t>& bytes,
                const std::string& path) {
    if (view.filter == "NONE") return;
    const bool octahedral = view.filter == "OCTAHEDRAL", quaternion = view.filter == "QUATERNION";
    const bool known = octahedral || quaternion || view.filter == "EXPONENTIAL";
    const bool fits = view.mode == "ATTRIBUTES" && (!octahedral || view.stride == 4 || view.stride == 8) &&
                      (!quaternion || view.stride == 8);
    if (!known || !fits)
        document.fail(path + "/filter", "no such filter for this layout", {}, view.filter.substr(0, 40));
    if (octahedral) meshopt_decodeFilterOct(bytes.data(), view.count, view.stride);
    else if (quaternion) meshopt_decodeFilterQuat(bytes.data(), view.count, view.stride);
    else meshopt_decodeFilterExp(bytes.data(), view.count, view.stride);
}

/// 0 if all is well.
int decodeInto(const Compressed& view, std::vector<uint8_t>& bytes) {
    const uint8_t* data = view.bytes.data();
    const size_t length = view.bytes.size();
    if (view.mode == "TRIANGLES") return meshopt_decodeIndexBuffer(bytes.data(), view.count, view.stride, data, length);
    if (view.mode == "INDICES") return meshopt_decodeIndexSequence(bytes.data(), view.count, view.stride, data, length);
    return meshopt_decodeVertexBuffer(bytes.data(), view.count, view.stride, data, length);
}

}  // namespace

bool isMeshopt(const tinygltf::BufferView& view) { return extensionOf(view.extensions, kExtension) != nullptr; }

std::vector<uint8_t> decodeMeshopt(const Document& document, const tinygltf::BufferView& source,
                                   const std::string& viewPath) {
    const std::string path = viewPath + "/extensions/" + kExtension;
    const Compressed view = readExtension(document, *extensionOf(source.extensions, kExtension), path);
    checkLayout(document, view, source.byteLength, path);
    checkMemory("a compressed buffer view", view.size());
    std::vector<uint8_t> bytes(view.size());
    if (bytes.empty()) return bytes;
    if (const int result = decodeInto(view, bytes); result != 0)
        document.fail(path, "the compressed bytes are damaged", {}, "decoder error " + std::to_string(result));
    undoFilter(document, view, bytes, path);
    return bytes;
}

}  // namespace lumi::gltf
