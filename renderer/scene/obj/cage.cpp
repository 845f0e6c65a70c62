#include "scene/obj/cage.h"

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include "base/error.h"
#include "base/files.h"
#include "scene/obj/number_check.h"

namespace lumi {
namespace {

/// `#t` at the beginning of a line becomes ` t`: files that keep the tags as comments.
void uncommentTags(std::string& text) {
    for (size_t at = 0; at < text.size(); at = text.find('\n', at) + 1) {
        if (text.compare(at, 3, "#t ") == 0) text[at] = ' ';
        if (text.find('\n', at) == std::string::npos) break;
    }
}

void addCreases(const tinyobj::tag_t& tag, SubdivisionCage& cage) {
    for (size_t i = 0; i + 1 < tag.intValues.size(); ++i) {
        const float sharpness = tag.floatValues.empty() ? 10.0f
                                                        : static_cast<float>(tag.floatValues[std::min(i, tag.floatValues.size() - 1)]);
        cage.creases.push_back({static_cast<uint32_t>(tag.intValues[i]), static_cast<uint32_t>(tag.intValues[i + 1]),
                                sharpness});
    }
}

void addCorners(const tinyobj::tag_t& tag, SubdivisionCage& cage) {
    for (size_t i = 0; i < tag.intValues.size(); ++i) {
        const float sharpness = tag.floatValues.empty() ? 10.0f
                                                        : static_cast<float>(tag.floatValues[std::min(i, tag.floatValues.size() - 1)]);
        cage.corners.push_back({static_cast<uint32_t>(tag.intValues[i]), sharpness});
    }
}

int firstInt(const tinyobj::tag_t& tag) { return tag.intValues.empty() ? 0 : tag.intValues[0]; }

void applyTag(const tinyobj::tag_t& tag, SubdivisionCage& cage) {
    using Boundary = SubdivisionCage::Boundary;
    if (tag.name == "crease") addCreases(tag, cage);
    if (tag.name == "corner") addCorners(tag, cage);
    if (tag.name == "hole" && !tag.intValues.empty()) cage.holes.push_back(static_cast<uint32_t>(tag.intValues[0]));
    if (tag.name == "interpolateboundary") {
        constexpr Boundary kRules[] = {Boundary::None, Boundary::EdgeAndCorner, Boundary::EdgeOnly};
        const int rule = firstInt(tag);
        if (rule >= 0 && rule < 3) cage.boundary = kRules[rule];
    }
    if (tag.name == "facevaryinginterpolateboundary" && firstInt(tag) >= 0 && firstInt(tag) < 6)
        cage.faceVarying = static_cast<SubdivisionCage::FaceVarying>(firstInt(tag));
    if (tag.name == "creasemethod") cage.chaikin = !tag.stringValues.empty() && tag.stringValues[0] == "chaikin";
    if (tag.name == "smoothtriangles") cage.smoothTriangles = firstInt(tag) != 0;
}

}  // namespace

SubdivisionCage parseCage(std::string text, const std::string& where, MessageLog& log) {
    checkObjNumbers(text, where, log);
    uncommentTags(text);
    tinyobj::ObjReaderConfig config;
    config.triangulate = false;
    config.vertex_color = false;
    tinyobj::ObjReader reader;
    if (!reader.ParseFromString(text, "", config))
        throwBadInput({"is not a readable OBJ file", where, "", reader.Error().substr(0, reader.Error().find('\n'))});

    SubdivisionCage cage;
    cage.name = where;
    cage.boundary = SubdivisionCage::Boundary::EdgeOnly;
    const tinyobj::attrib_t& attributes = reader.GetAttrib();
    for (size_t i = 0; i + 2 < attributes.vertices.size(); i += 3)
        cage.positions.emplace_back(attributes.vertices[i], attributes.vertices[i + 1], attributes.vertices[i + 2]);
    for (size_t i = 0; i + 1 < attributes.texcoords.size(); i += 2)
        cage.uvs.emplace_back(attributes.texcoords[i], attributes.texcoords[i + 1]);

    bool everyCornerHasUv = !cage.uvs.empty();
    for (const tinyobj::shape_t& shape : reader.GetShapes()) {
        // tinyobj keeps a face's number of corners in a byte, which larger faces overflow.
        uint64_t corners = 0;
        for (const auto size : shape.mesh.num_face_vertices) cage.faceSizes.push_back(size), corners += size;
        if (corners != shape.mesh.indices.size())
            throwBadInput({"a face has too many corners", where, "at most 255", ""});
        for (const tinyobj::index_t& index : shape.mesh.indices) {
            if (index.vertex_index < 0) throwBadInput({"a face names a vertex that does not exist", where, "", ""});
            cage.faceVertices.push_back(static_cast<uint32_t>(index.vertex_index));
            everyCornerHasUv = everyCornerHasUv && index.texcoord_index >= 0;
            cage.faceUvs.push_back(static_cast<uint32_t>(std::max(index.texcoord_index, 0)));
        }
        for (const tinyobj::tag_t& tag : shape.mesh.tags) applyTag(tag, cage);
    }
    if (!everyCornerHasUv) cage.uvs.clear(), cage.faceUvs.clear();
    if (cage.faceSizes.empty()) throwBadInput({"holds no faces", where, "a polygon cage", ""});
    return cage;
}

SubdivisionCage loadCage(const std::filesystem::path& path, MessageLog& log) {
    return parseCage(readTextFile(path), path.string(), log);
}

}  // namespace lumi
