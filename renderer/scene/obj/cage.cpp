#include "scene/obj/cage.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <string_view>
#include <unordered_set>

#include "base/error.h"
#include "scene/obj/number_check.h"
#include "scene/obj/obj_text.h"

namespace lumi {
namespace {

using Tag = tinyobj::tag_t;

/// Of the tag's i-th thing: the last float stands for all that follow, and infinitely sharp for none.
float sharpnessAt(const Tag& tag, size_t i) {
    if (tag.floatValues.empty()) return 10;
    return static_cast<float>(tag.floatValues[std::min(i, tag.floatValues.size() - 1)]);
}

int firstInt(const Tag& tag) { return tag.intValues.empty() ? 0 : tag.intValues[0]; }

void addCreases(const Tag& tag, SubdivisionCage& cage, FileWarnings&) {
    for (size_t i = 0; i + 1 < tag.intValues.size(); ++i)
        cage.creases.push_back({static_cast<uint32_t>(tag.intValues[i]), static_cast<uint32_t>(tag.intValues[i + 1]),
                                sharpnessAt(tag, i)});
}

void addCorners(const Tag& tag, SubdivisionCage& cage, FileWarnings&) {
    for (size_t i = 0; i < tag.intValues.size(); ++i)
        cage.corners.push_back({static_cast<uint32_t>(tag.intValues[i]), sharpnessAt(tag, i)});
}

void addHoles(const Tag& tag, SubdivisionCage& cage, FileWarnings&) {
    for (const int face : tag.intValues) cage.holes.push_back(static_cast<uint32_t>(face));
}

/// Is the tag's rule one of 0 to `last`? If not, it is said and the tag left out.
bool isRule(const Tag& tag, int last, FileWarnings& warnings) {
    if (firstInt(tag) >= 0 && firstInt(tag) <= last) return true;
    warnings.warn(fmt::format("the subdivision tag \"{}\" has no rule {} (0 to {}) and is left out", tag.name,
                              firstInt(tag), last));
    return false;
}

void setBoundary(const Tag& tag, SubdivisionCage& cage, FileWarnings& warnings) {
    using Boundary = SubdivisionCage::Boundary;
    constexpr Boundary kRules[] = {Boundary::None, Boundary::EdgeAndCorner, Boundary::EdgeOnly};
    if (isRule(tag, 2, warnings)) cage.boundary = kRules[firstInt(tag)];
}

void setFaceVarying(const Tag& tag, SubdivisionCage& cage, FileWarnings& warnings) {
    if (isRule(tag, 5, warnings)) cage.faceVarying = static_cast<SubdivisionCage::FaceVarying>(firstInt(tag));
}

void setCreaseMethod(const Tag& tag, SubdivisionCage& cage, FileWarnings& warnings) {
    const std::string method = tag.stringValues.empty() ? "" : tag.stringValues[0];
    cage.chaikin = method == "chaikin";
    if (method != "chaikin" && method != "normal" && method != "uniform")
        warnings.warn(fmt::format("the crease method \"{}\" is unknown; uniform creases are taken", method));
}

/// A number, or OpenSubdiv's own words: "catmark", "smooth".
void setSmoothTriangles(const Tag& tag, SubdivisionCage& cage, FileWarnings&) {
    cage.smoothTriangles = tag.stringValues.empty() ? firstInt(tag) != 0 : tag.stringValues[0] == "smooth";
}

struct KnownTag {
    std::string_view name;
    void (*apply)(const Tag&, SubdivisionCage&, FileWarnings&);  ///< null: of a cage, but left out
};

constexpr KnownTag kKnownTags[] = {
    {"crease", addCreases},
    {"corner", addCorners},
    {"hole", addHoles},
    {"interpolateboundary", setBoundary},
    {"facevaryinginterpolateboundary", setFaceVarying},
    {"creasemethod", setCreaseMethod},
    {"smoothtriangles", setSmoothTriangles},
    {"vertexedit", nullptr},
    {"edgeedit", nullptr},
    {"faceedit", nullptr},
};

const KnownTag* knownTag(std::string_view name) {
    const auto found = std::ranges::find(kKnownTags, name, &KnownTag::name);
    return found != std::end(kKnownTags) ? found : nullptr;
}

bool isApplied(const Tag& tag) {
    const KnownTag* known = knownTag(tag.name);
    return known && known->apply;
}

/// "#t crease 2/1/0 ...", and no sentence of a comment: a tag's name and then how many numbers follow.
bool isCommentedTag(std::string_view line) {
    if (!line.starts_with("#t ")) return false;
    line.remove_prefix(3);
    const size_t end = line.find_first_of(" \t");
    if (end == line.npos || !knownTag(line.substr(0, end))) return false;
    line.remove_prefix(line.find_first_not_of(" \t", end) == line.npos ? line.size()
                                                                       : line.find_first_not_of(" \t", end));
    return !line.empty() && line[0] >= '0' && line[0] <= '9';
}

void addFaces(const tinyobj::mesh_t& mesh, uint32_t fallbackMaterial, const std::string& where, SubdivisionCage& cage) {
    // tinyobj keeps a face's number of corners in a byte, which larger faces overflow.
    const uint64_t corners = std::accumulate(mesh.num_face_vertices.begin(), mesh.num_face_vertices.end(), uint64_t(0));
    if (corners != mesh.indices.size()) throwBadInput({"a face has too many corners", where, "at most 255", ""});
    cage.faceSizes.insert(cage.faceSizes.end(), mesh.num_face_vertices.begin(), mesh.num_face_vertices.end());
    for (size_t face = 0; face < mesh.num_face_vertices.size(); ++face) {
        const int material = face < mesh.material_ids.size() ? mesh.material_ids[face] : -1;
        cage.faceMaterials.push_back(material < 0 ? fallbackMaterial : static_cast<uint32_t>(material));
    }
    for (const tinyobj::index_t& index : mesh.indices) {
        if (index.vertex_index < 0) throwBadInput({"a face names a vertex that does not exist", where, "", ""});
        cage.faceVertices.push_back(static_cast<uint32_t>(index.vertex_index));
        cage.faceUvs.push_back(static_cast<uint32_t>(std::max(index.texcoord_index, 0)));
    }
}

/// OpenSubdiv skips creases where no edge is.
void warnOfCreasesOffEdges(const SubdivisionCage& cage, FileWarnings& warnings) {
    if (cage.creases.empty()) return;
    const auto edge = [](uint32_t a, uint32_t b) { return uint64_t(std::min(a, b)) << 32 | std::max(a, b); };
    std::unordered_set<uint64_t> edges;
    for (size_t face = 0, first = 0; face < cage.faceSizes.size(); first += cage.faceSizes[face++])
        for (uint32_t i = 0, size = cage.faceSizes[face]; i < size; ++i)
            edges.insert(edge(cage.faceVertices[first + i], cage.faceVertices[first + (i + 1) % size]));
    // Those beyond the vertices are refused later.
    const auto isOff = [&](const auto& crease) {
        return std::max(crease.a, crease.b) < cage.positions.size() && !edges.contains(edge(crease.a, crease.b));
    };
    const auto first = std::ranges::find_if(cage.creases, isOff);
    if (first == cage.creases.end()) return;
    const auto count = std::ranges::count_if(cage.creases, isOff);
    warnings.warn(fmt::format("{} along no edge, {} vertices {} and {}, left out",
                              count == 1 ? "a crease" : fmt::format("{} creases", count),
                              count == 1 ? "between" : "the first between", first->a, first->b));
}

bool everyCornerHasUv(const std::vector<tinyobj::shape_t>& shapes) {
    for (const tinyobj::shape_t& shape : shapes)
        for (const tinyobj::index_t& index : shape.mesh.indices)
            if (index.texcoord_index < 0) return false;
    return true;
}

}  // namespace

void uncommentTags(std::string& text) {
    for (size_t at = 0; at < text.size(); at = text.find('\n', at) + 1) {
        const size_t end = std::min(text.find('\n', at), text.size());
        if (isCommentedTag(std::string_view(text).substr(at, end - at))) text[at] = ' ';
        if (end == text.size()) break;
    }
}

std::optional<SubdivisionCage::Scheme> saidScheme(std::string_view text, FileWarnings& warnings) {
    using Scheme = SubdivisionCage::Scheme;
    constexpr std::string_view kMark = "# scheme: ";
    constexpr std::pair<std::string_view, Scheme> kNames[] = {{"catmark", Scheme::CatmullClark},
                                                              {"bilinear", Scheme::Bilinear}};
    for (size_t at = text.find(kMark); at != text.npos; at = text.find(kMark, at + 1)) {
        if (at > 0 && text[at - 1] != '\n') continue;
        const std::string_view rest = text.substr(at + kMark.size());
        const std::string_view name = rest.substr(0, rest.find_first_of(" \t\r\n;,"));
        for (const auto& [known, scheme] : kNames)
            if (name == known) return scheme;
        if (!name.empty()) warnings.warn(fmt::format("the subdivision scheme \"{}\" is not supported", name));
    }
    return std::nullopt;
}

bool hasTags(const std::vector<tinyobj::shape_t>& shapes) {
    return std::any_of(shapes.begin(), shapes.end(), [](const tinyobj::shape_t& shape) {
        return std::any_of(shape.mesh.tags.begin(), shape.mesh.tags.end(),
                           [](const Tag& tag) { return knownTag(tag.name) != nullptr; });
    });
}

void warnOfOtherTags(const std::vector<tinyobj::shape_t>& shapes, FileWarnings& warnings) {
    std::set<std::string> names;
    for (const tinyobj::shape_t& shape : shapes)
        for (const Tag& tag : shape.mesh.tags)
            if (!isApplied(tag) && names.insert(tag.name).second)
                warnings.warn(fmt::format("the subdivision tag \"{}\" is not supported and left out", tag.name));
}

SubdivisionCage cageOf(const tinyobj::attrib_t& attributes, const std::vector<tinyobj::shape_t>& shapes,
                       SubdivisionCage::Scheme scheme, uint32_t fallbackMaterial, FileWarnings& warnings) {
    const std::string& where = warnings.file();
    SubdivisionCage cage;
    cage.name = where;
    cage.scheme = scheme;
    cage.boundary = SubdivisionCage::Boundary::EdgeOnly;
    for (size_t i = 0; i + 2 < attributes.vertices.size(); i += 3)
        cage.positions.emplace_back(attributes.vertices[i], attributes.vertices[i + 1], attributes.vertices[i + 2]);
    for (const tinyobj::shape_t& shape : shapes) {
        addFaces(shape.mesh, fallbackMaterial, where, cage);
        for (const Tag& tag : shape.mesh.tags)
            if (isApplied(tag)) knownTag(tag.name)->apply(tag, cage, warnings);
    }
    warnOfCreasesOffEdges(cage, warnings);
    // Bilinear surfaces end where their cage ends, whatever the tags say.
    if (scheme == SubdivisionCage::Scheme::Bilinear) cage.boundary = SubdivisionCage::Boundary::EdgeAndCorner;
    warnOfOtherTags(shapes, warnings);
    if (cage.faceSizes.empty()) throwBadInput({"holds no faces", where, "a polygon cage", ""});
    cage.material = cage.faceMaterials.front();
    if (std::count(cage.faceMaterials.begin(), cage.faceMaterials.end(), cage.material) ==
        std::ssize(cage.faceMaterials))
        cage.faceMaterials.clear();
    if (!attributes.texcoords.empty() && everyCornerHasUv(shapes))
        for (size_t i = 0; i + 1 < attributes.texcoords.size(); i += 2)
            cage.uvs.emplace_back(attributes.texcoords[i], 1 - attributes.texcoords[i + 1]);
    else cage.faceUvs.clear();
    return cage;
}

SubdivisionCage parseCage(std::string text, const std::string& where, MessageLog& log) {
    FileWarnings warnings(where, log);
    text = plainObj(text, [](const std::string&) { return false; });
    checkObjNumbers(text, warnings);
    uncommentTags(text);
    const auto scheme = saidScheme(text, warnings).value_or(SubdivisionCage::Scheme::CatmullClark);
    tinyobj::ObjReaderConfig config;
    config.triangulate = false;
    config.vertex_color = false;
    tinyobj::ObjReader reader;
    if (!reader.ParseFromString(text, "", config))
        throwBadInput({"is not a readable OBJ file", where, "", reader.Error().substr(0, reader.Error().find('\n'))});
    SubdivisionCage cage = cageOf(reader.GetAttrib(), reader.GetShapes(), scheme, 0, warnings);
    warnings.tellOfMore();
    return cage;
}

}  // namespace lumi
