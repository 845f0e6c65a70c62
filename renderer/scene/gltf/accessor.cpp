#include "scene/gltf/accessor.h"

#include <algorithm>
#include <cstring>
#include <type_traits>

#include "base/memory.h"

namespace lumi::gltf {
namespace {

/// A checked run of elements in a buffer; `data` null stands for zeros.
struct Elements {
    const uint8_t* data = nullptr;
    size_t stride = 0, count = 0;
    int components = 0, componentType = 0;
    bool normalized = false;
};

size_t componentBytes(int type) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return 1;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return 2;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        case TINYGLTF_COMPONENT_TYPE_FLOAT: return 4;
        default: return 0;
    }
}

bool isIndexType(int type) {
    return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
           type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

template <class From, class To>
void convertRun(const Elements& from, float scale, float lowest, To* out, size_t outStride) {
    for (size_t i = 0; i < from.count; ++i) {
        const uint8_t* element = from.data + i * from.stride;
        for (int c = 0; c < from.components; ++c) {
            From value;
            std::memcpy(&value, element + static_cast<size_t>(c) * sizeof(From), sizeof(From));
            if constexpr (std::is_floating_point_v<To>)
                out[i * outStride + static_cast<size_t>(c)] = std::max(static_cast<To>(value) * scale, lowest);
            else out[i * outStride + static_cast<size_t>(c)] = static_cast<To>(value);
        }
    }
}

/// Writes all elements as To. Normalised signed integers map both of their lowest codes to -1, as glTF asks.
template <class To>
void convert(const Elements& from, To* out) {
    if (from.count == 0) return;
    const size_t n = static_cast<size_t>(from.components);
    const float none = -kInfinity, minusOne = -1;
    const auto scale = [&](float largest) { return from.normalized ? 1 / largest : 1.0f; };
    switch (from.componentType) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return convertRun<int8_t>(from, scale(127), from.normalized ? minusOne : none, out, n);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return convertRun<uint8_t>(from, scale(255), none, out, n);
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return convertRun<int16_t>(from, scale(32767), from.normalized ? minusOne : none, out, n);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return convertRun<uint16_t>(from, scale(65535), none, out, n);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return convertRun<uint32_t>(from, scale(4294967295.0f), none, out, n);
        default: break;
    }
    if constexpr (std::is_same_v<To, float>) {
        const size_t bytes = n * sizeof(float);
        if (from.stride == bytes) std::memcpy(out, from.data, from.count * bytes);
        else
            for (size_t i = 0; i < from.count; ++i) std::memcpy(out + i * n, from.data + i * from.stride, bytes);
    }
}

class Reader {
public:
    Reader(const Document& document, int index, const std::string& jsonPath, const DecodedElements* decoded)
        : document_(document), decoded_(decoded) {
        document.checkIndex(index, document.model().accessors.size(), jsonPath, "accessors");
        accessor_ = &document.model().accessors[static_cast<size_t>(index)];
        path_ = "/accessors/" + std::to_string(index);
        elements_.components = tinygltf::GetNumComponentsInType(static_cast<uint32_t>(accessor_->type));
        elements_.componentType = accessor_->componentType;
        elements_.count = accessor_->count;
        elements_.normalized = accessor_->normalized;
        if (decoded) {
            elements_.components = decoded->components;
            elements_.componentType = decoded->componentType;
        }
        componentBytes_ = componentBytes(elements_.componentType);
        if (componentBytes_ == 0 || elements_.components <= 0)
            document.fail(path_ + "/componentType", "unsupported component type", "5120 to 5126",
                          std::to_string(accessor_->componentType));
        // Without a buffer behind it, a count costs the file nothing: such accessors are kept to sizes that exist.
        const size_t most = accessor_->bufferView < 0 ? size_t(1) << 26 : size_t(1) << 32;
        if (elements_.count >= most)
            document.fail(path_ + "/count", "absurd count", "below " + std::to_string(most),
                          std::to_string(elements_.count));
    }

    void expectComponents(int components, const std::string& jsonPath) const {
        if (elements_.components == components) return;
        document_.fail(jsonPath, path_ + " has the wrong type", std::to_string(components) + " components",
                       std::to_string(elements_.components));
    }
    void expectIntegers(const std::string& jsonPath) const {
        if (!isIndexType(elements_.componentType))
            document_.fail(jsonPath, path_ + " does not hold unsigned integers", "5121, 5123 or 5125",
                           std::to_string(elements_.componentType));
    }

    template <class To>
    std::vector<To> read() {
        locate();
        const size_t values = elements_.count * static_cast<size_t>(elements_.components);
        checkMemory("an accessor", values * sizeof(To));
        std::vector<To> out(values);
        if (elements_.data) convert(elements_, out.data());
        if (accessor_->sparse.isSparse && !decoded_) putSparse(out);
        return out;
    }

private:
    size_t elementBytes() const { return componentBytes_ * static_cast<size_t>(elements_.components); }

    /// Checks that all elements lie within their buffer view.
    void locate() {
        if (decoded_) {
            elements_.stride = elementBytes();
            elements_.data = decoded_->bytes.data();
            checkFits(decoded_->bytes.size(), 0, elements_.stride, elements_.count, elementBytes(), path_);
            return;
        }
        if (accessor_->bufferView < 0) return;
        const std::span<const uint8_t> view = document_.bufferView(accessor_->bufferView, path_ + "/bufferView");
        const size_t stride = document_.model().bufferViews[static_cast<size_t>(accessor_->bufferView)].byteStride;
        if (stride > 0 && stride < elementBytes() && elements_.count > 1)
            document_.fail("/bufferViews/" + std::to_string(accessor_->bufferView) + "/byteStride",
                           "is less than an element of " + path_, "at least " + std::to_string(elementBytes()),
                           std::to_string(stride));
        elements_.stride = stride > 0 ? stride : elementBytes();
        checkFits(view.size(), accessor_->byteOffset, elements_.stride, elements_.count, elementBytes(), path_);
        elements_.data = view.data() + accessor_->byteOffset;
    }

    void checkFits(size_t available, size_t offset, size_t stride, size_t count, size_t bytes,
                   const std::string& path) const {
        if (count == 0 && offset <= available) return;
        // Below 2^32 elements of at most 252 + 64 bytes: no overflow.
        const size_t needed = (count - 1) * stride + bytes;
        if (offset > available || needed > available - offset)
            document_.fail(path, "reaches past the end of its buffer view",
                           "at most " + std::to_string(available) + " bytes",
                           std::to_string(offset) + " + " + std::to_string(needed));
    }

    /// One of the two tightly packed arrays of a sparse accessor.
    Elements sparseArray(int view, int offset, int componentType, int components, const std::string& path) const {
        const size_t component = componentBytes(componentType);
        if (component == 0) document_.fail(path, "unsupported component type", {}, std::to_string(componentType));
        Elements array;
        array.components = components;
        array.componentType = componentType;
        array.normalized = elements_.normalized;
        array.count = static_cast<size_t>(accessor_->sparse.count);
        array.stride = component * static_cast<size_t>(components);
        const std::span<const uint8_t> bytes = document_.bufferView(view, path + "/bufferView");
        checkFits(bytes.size(), static_cast<size_t>(offset), array.stride, array.count, array.stride, path);
        array.data = bytes.data() + offset;
        return array;
    }

    template <class To>
    void putSparse(std::vector<To>& out) const {
        const auto& sparse = accessor_->sparse;
        const std::string path = path_ + "/sparse";
        if (static_cast<size_t>(sparse.count) > elements_.count)
            document_.fail(path + "/count", "absurd count", "0 to " + std::to_string(elements_.count),
                           std::to_string(sparse.count));
        const Elements places = sparseArray(sparse.indices.bufferView, sparse.indices.byteOffset,
                                            sparse.indices.componentType, 1, path + "/indices");
        if (!isIndexType(sparse.indices.componentType))
            document_.fail(path + "/indices/componentType", "does not hold unsigned integers", "5121, 5123 or 5125",
                           std::to_string(sparse.indices.componentType));
        const Elements values = sparseArray(sparse.values.bufferView, sparse.values.byteOffset, elements_.componentType,
                                            elements_.components, path + "/values");
        std::vector<uint32_t> indices(places.count);
        convert(places, indices.data());
        const size_t n = static_cast<size_t>(elements_.components);
        std::vector<To> replacements(values.count * n);
        convert(values, replacements.data());
        for (size_t i = 0; i < indices.size(); ++i) {
            document_.checkIndex(indices[i], elements_.count, path + "/indices", "elements of the accessor");
            std::copy_n(&replacements[i * n], n, &out[indices[i] * n]);
        }
    }

    const Document& document_;
    const DecodedElements* decoded_;
    const tinygltf::Accessor* accessor_ = nullptr;
    std::string path_;
    Elements elements_;
    size_t componentBytes_ = 0;
};

}  // namespace

std::vector<float> readFloats(const Document& document, int index, int components, const std::string& jsonPath,
                              const DecodedElements* decoded) {
    Reader reader(document, index, jsonPath, decoded);
    reader.expectComponents(components, jsonPath);
    return reader.read<float>();
}

template <class T>
std::vector<T> readVectors(const Document& document, int index, const std::string& jsonPath,
                           const DecodedElements* decoded) {
    static_assert(sizeof(T) % sizeof(float) == 0);
    const std::vector<float> values =
        readFloats(document, index, static_cast<int>(sizeof(T) / sizeof(float)), jsonPath, decoded);
    std::vector<T> vectors(values.size() * sizeof(float) / sizeof(T));
    if (!vectors.empty()) std::memcpy(static_cast<void*>(vectors.data()), values.data(), values.size() * sizeof(float));
    return vectors;
}

template std::vector<Vec2> readVectors<Vec2>(const Document&, int, const std::string&, const DecodedElements*);
template std::vector<Vec3> readVectors<Vec3>(const Document&, int, const std::string&, const DecodedElements*);
template std::vector<Vec4> readVectors<Vec4>(const Document&, int, const std::string&, const DecodedElements*);
template std::vector<Mat4> readVectors<Mat4>(const Document&, int, const std::string&, const DecodedElements*);

std::vector<uint32_t> readIntegers(const Document& document, int index, int components, const std::string& jsonPath,
                                   const DecodedElements* decoded) {
    Reader reader(document, index, jsonPath, decoded);
    reader.expectComponents(components, jsonPath);
    reader.expectIntegers(jsonPath);
    return reader.read<uint32_t>();
}

size_t elementCount(const Document& document, int index, const std::string& jsonPath) {
    document.checkIndex(index, document.model().accessors.size(), jsonPath, "accessors");
    return document.model().accessors[static_cast<size_t>(index)].count;
}

int componentCount(const Document& document, int index, const std::string& jsonPath) {
    document.checkIndex(index, document.model().accessors.size(), jsonPath, "accessors");
    const int type = document.model().accessors[static_cast<size_t>(index)].type;
    return tinygltf::GetNumComponentsInType(static_cast<uint32_t>(type));
}

}  // namespace lumi::gltf
