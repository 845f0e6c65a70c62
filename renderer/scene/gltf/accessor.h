#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "math/vector.h"
#include "scene/gltf/document.h"

namespace lumi::gltf {

/// Elements that were decoded from elsewhere in place of an accessor's own, tightly packed.
struct DecodedElements {
    std::vector<uint8_t> bytes;
    int components = 0, componentType = 0;  ///< as an accessor spells them
};

/// Elements of accessor `index`, with `components` numbers each, as floats: normalised integers become [0,1] or [-1,1],
/// others their value; sparse elements are put in. Row-major by element. Everything is checked against the file before
/// memory is taken. `jsonPath` is where the file names the accessor; `decoded`, where given, replaces its bytes. Throws
/// Error(BadInput).
std::vector<float> readFloats(const Document& document, int index, int components, const std::string& jsonPath,
                              const DecodedElements* decoded = nullptr);

/// As readFloats, into vectors of any type that is `N` packed floats: Vec2, Vec3, Vec4, Mat4.
template <class T>
std::vector<T> readVectors(const Document& document, int index, const std::string& jsonPath,
                           const DecodedElements* decoded = nullptr);

/// Unsigned integers (vertex indices, joints), `components` each.
std::vector<uint32_t> readIntegers(const Document& document, int index, int components, const std::string& jsonPath,
                                   const DecodedElements* decoded = nullptr);

/// Number of elements; checks only the index.
size_t elementCount(const Document& document, int index, const std::string& jsonPath);
/// Numbers in an element: 1 for SCALAR, 4 for VEC4 and MAT2, ...
int componentCount(const Document& document, int index, const std::string& jsonPath);

}  // namespace lumi::gltf
