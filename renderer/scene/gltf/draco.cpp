#include "scene/gltf/draco.h"

#include <draco/compression/decode.h>
#include <draco/compression/point_cloud/point_cloud_decoder.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/metadata_decoder.h>

#include <algorithm>
#include <cstring>

#include "base/memory.h"
#include "scene/gltf/values.h"

namespace lumi::gltf {
namespace {

constexpr const char* kExtension = "KHR_draco_mesh_compression";

struct Counts {
    uint32_t faces = 0, vertices = 0;
};

/// Reads a Draco stream's header as far as its counts [Draco bitstream specification 2.2, sections 3 to 5].
bool peekCounts(std::span<const uint8_t> bytes, Counts& counts) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::DracoHeader header{};
    if (!draco::PointCloudDecoder::DecodeHeader(&buffer, &header).ok()) return false;
    if (header.encoder_type != draco::TRIANGULAR_MESH) return false;
    if (header.version_major != 2 || header.version_minor < 2) return false;
    buffer.set_bitstream_version(DRACO_BITSTREAM_VERSION(header.version_major, header.version_minor));
    if (header.flags & METADATA_FLAG_MASK) {
        draco::GeometryMetadata ignored;
        if (!draco::MetadataDecoder().DecodeGeometryMetadata(&buffer, &ignored)) return false;
    }
    if (header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING) {
        uint8_t traversal = 0;
        return buffer.Decode(&traversal) && draco::DecodeVarint(&counts.vertices, &buffer) &&
               draco::DecodeVarint(&counts.faces, &buffer);
    }
    return draco::DecodeVarint(&counts.faces, &buffer) && draco::DecodeVarint(&counts.vertices, &buffer);
}

int componentType(draco::DataType type) {
    switch (type) {
        case draco::DT_INT8: return TINYGLTF_COMPONENT_TYPE_BYTE;
        case draco::DT_UINT8: return TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE;
        case draco::DT_INT16: return TINYGLTF_COMPONENT_TYPE_SHORT;
        case draco::DT_UINT16: return TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
        case draco::DT_UINT32: return TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
        case draco::DT_FLOAT32: return TINYGLTF_COMPONENT_TYPE_FLOAT;
        default: return 0;
    }
}

class DracoReader {
public:
    DracoReader(const Document& document, const tinygltf::Primitive& primitive, const tinygltf::Value& extension,
                const std::string& primitivePath)
        : document_(document),
          primitive_(primitive),
          extension_(extension),
          primitivePath_(primitivePath),
          path_(primitivePath + "/extensions/" + kExtension) {}

    std::unique_ptr<const DracoMesh> read() const {
        const int view = integerOf(extension_, "bufferView", -1);
        const std::span<const uint8_t> bytes = document_.bufferView(view, path_ + "/bufferView");
        const Counts promised = promisedCounts();
        Counts counts;
        if (!peekCounts(bytes, counts)) document_.fail(path_, "is no Draco mesh of version 2.2");
        if (counts.faces > promised.faces || counts.vertices > promised.vertices)
            document_.fail(path_, "holds more than its accessors say", text(promised), text(counts));
        // Flat grids take a bit for each vertex; more than 64 times fewer are no mesh that someone made.
        const uint64_t most = (uint64_t(1) << 16) + 512 * uint64_t(bytes.size());
        if (std::max(counts.faces, counts.vertices) > most)
            document_.fail(path_, "absurd counts for its size", "at most " + std::to_string(most), text(counts));
        checkMemory("a Draco mesh", uint64_t(counts.faces) * 200 + uint64_t(promised.vertices) * 200);

        draco::DecoderBuffer buffer;
        buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        auto decoded = draco::Decoder().DecodeMeshFromBuffer(&buffer);
        if (!decoded.ok())
            document_.fail(path_, "the Draco data is damaged", {}, decoded.status().error_msg_string().substr(0, 120));
        const draco::Mesh& mesh = *decoded.value();
        counts = {mesh.num_faces(), mesh.num_points()};
        if (counts.faces != promised.faces || counts.vertices != promised.vertices)
            document_.fail(path_, "does not hold what its accessors say", text(promised), text(counts));
        return convert(mesh);
    }

private:
    static std::string text(const Counts& c) {
        return std::to_string(c.vertices) + " vertices, " + std::to_string(c.faces) + " triangles";
    }

    /// What the accessors of positions and indices announce.
    Counts promisedCounts() const {
        const auto position = primitive_.attributes.find("POSITION");
        if (position == primitive_.attributes.end()) document_.fail(primitivePath_ + "/attributes", "has no POSITION");
        const int indicesAccessor = integerOf(extension_, "indices", -1);  // put there by makeReadable()
        if (indicesAccessor < 0) document_.fail(primitivePath_ + "/indices", "is missing beside Draco data");
        const size_t vertices = elementCount(document_, position->second, primitivePath_ + "/attributes/POSITION");
        const size_t indices = elementCount(document_, indicesAccessor, primitivePath_ + "/indices");
        if (vertices >= (size_t(1) << 31) || indices >= (size_t(1) << 32))
            document_.fail(path_, "absurd count", "below 2^31", std::to_string(std::max(vertices, indices)));
        return {static_cast<uint32_t>(indices / 3), static_cast<uint32_t>(vertices)};
    }

    std::unique_ptr<const DracoMesh> convert(const draco::Mesh& mesh) const {
        auto out = std::make_unique<DracoMesh>();
        out->triangles.reserve(mesh.num_faces());
        for (draco::FaceIndex f(0); f < mesh.num_faces(); ++f) {
            const auto& face = mesh.face(f);
            out->triangles.emplace_back(face[0].value(), face[1].value(), face[2].value());
            const UVec3& t = out->triangles.back();
            if (std::max({t.x, t.y, t.z}) >= mesh.num_points()) document_.fail(path_, "the Draco data is damaged");
        }
        if (!extension_.Has("attributes") || !extension_.Get("attributes").IsObject())
            document_.fail(path_ + "/attributes", "is missing");
        const tinygltf::Value& names = extension_.Get("attributes");
        for (const std::string& name : names.Keys()) {
            const int id = integerOf(names, name, -1);
            const draco::PointAttribute* attribute =
                id < 0 ? nullptr : mesh.GetAttributeByUniqueId(static_cast<uint32_t>(id));
            const std::string where = path_ + "/attributes/" + name;
            if (!attribute) document_.fail(where, "no such attribute in the Draco data", {}, std::to_string(id));
            out->attributes.emplace(name, elements(*attribute, mesh.num_points(), name));
        }
        return out;
    }

    DecodedElements elements(const draco::PointAttribute& attribute, uint32_t points, const std::string& name) const {
        DecodedElements out;
        out.components = attribute.num_components();
        out.componentType = componentType(attribute.data_type());
        const auto stride = static_cast<size_t>(attribute.byte_stride());
        const auto packed =
            static_cast<size_t>(out.components) * static_cast<size_t>(draco::DataTypeLength(attribute.data_type()));
        if (out.componentType == 0 || stride != packed)
            document_.fail(path_ + "/attributes/" + name, "has a type that glTF does not know");
        checkMemory("a Draco attribute", points * stride);
        out.bytes.resize(points * stride);
        for (uint32_t p = 0; p < points; ++p) {
            const auto index = attribute.mapped_index(draco::PointIndex(p));
            if (index.value() >= attribute.size()) document_.fail(path_, "the Draco data is damaged");
            std::memcpy(&out.bytes[p * stride], attribute.GetAddress(index), stride);
        }
        return out;
    }

    const Document& document_;
    const tinygltf::Primitive& primitive_;
    const tinygltf::Value& extension_;
    const std::string& primitivePath_;
    std::string path_;
};

}  // namespace

std::unique_ptr<const DracoMesh> decodeDraco(const Document& document, const tinygltf::Primitive& primitive,
                                             const std::string& path) {
    const tinygltf::Value* extension = extensionOf(primitive.extensions, kExtension);
    return extension ? DracoReader(document, primitive, *extension, path).read() : nullptr;
}

}  // namespace lumi::gltf
