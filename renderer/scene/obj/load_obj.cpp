#include "scene/obj/load_obj.h"

#include <tiny_obj_loader.h>

#include <algorithm>
#include <optional>
#include <sstream>

#include "base/error.h"
#include "base/files.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "scene/obj/cage.h"
#include "scene/obj/number_check.h"
#include "scene/obj/obj_materials.h"
#include "scene/obj/obj_mesh.h"
#include "scene/obj/obj_text.h"

namespace lumi {
namespace {

constexpr uint64_t kMaxObjBytes = uint64_t(4) << 30;
/// What tinyobj holds for a byte of text while it parses, at most.
constexpr uint64_t kBytesPerByte = 24;

/// Finds .mtl files in the .obj's folder only.
class FolderMaterials final : public tinyobj::MaterialReader {
public:
    FolderMaterials(std::filesystem::path folder, FileWarnings& warnings, uint64_t& digest)
        : folder_(std::move(folder)), warnings_(warnings), digest_(digest) {}

    bool operator()(const std::string& name, std::vector<tinyobj::material_t>* materials,
                    std::map<std::string, int>* byName, std::string*, std::string*) override {
        const std::optional<std::filesystem::path> file = pathInside(folder_, name);
        if (!file) {
            warnings_.warn("the material file \"" + name + "\" leads out of the .obj's folder");
            return true;
        }
        try {
            const std::vector<uint8_t> bytes = readFile(*file, uint64_t(1) << 28);
            digest_ = digest64(bytes, digest_);
            std::istringstream text(plainMtl({reinterpret_cast<const char*>(bytes.data()), bytes.size()}));
            std::string warning, error;
            tinyobj::LoadMtl(byName, materials, &text, &warning, &error);
        } catch (const Error& e) {
            warnings_.warn(std::string(e.what()) + "; its materials are left out");
        }
        return true;
    }

private:
    std::filesystem::path folder_;
    FileWarnings& warnings_;
    uint64_t& digest_;
};

struct ParsedObj {
    tinyobj::attrib_t attributes;
    std::vector<tinyobj::shape_t> shapes;
    std::vector<tinyobj::material_t> materials;
    std::optional<SubdivisionCage::Scheme> scheme;  ///< that it says
    uint64_t digest = 0;
};

ParsedObj parse(const std::filesystem::path& path, FileWarnings& warnings) {
    const std::string& where = warnings.file();
    std::vector<uint8_t> bytes = readFile(path, kMaxObjBytes);
    checkMemory("reading " + where, bytes.size() * kBytesPerByte);
    ParsedObj parsed;
    parsed.digest = digest64(bytes);
    const auto isThere = [&](const std::string& name) {
        const std::optional<std::filesystem::path> file = pathInside(path.parent_path(), name);
        std::error_code ignored;
        return file && std::filesystem::is_regular_file(*file, ignored);
    };
    std::string lines = plainObj({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, isThere);
    bytes = {};
    checkObjNumbers(lines, warnings);
    uncommentTags(lines);
    parsed.scheme = saidScheme(lines, warnings);
    std::istringstream text(std::move(lines));
    FolderMaterials materials(path.parent_path(), warnings, parsed.digest);
    std::string warning, error;
    try {
        const bool good = tinyobj::LoadObj(&parsed.attributes, &parsed.shapes, &parsed.materials, &warning, &error,
                                           &text, &materials, /*triangulate=*/false, /*default_vcols_fallback=*/false);
        if (!good)
            throwBadInput({.what = "damaged OBJ: " + error.substr(0, error.find_first_of("\r\n")), .where = where});
    } catch (const std::bad_alloc&) {
        throw Error(ErrorKind::Resources, {.what = "not enough memory to read the file", .where = where});
    }
    std::istringstream told(warning);
    for (std::string line; std::getline(told, line);)
        if (line.find_first_not_of(" .\t\r") != line.npos) warnings.warn(line);
    const auto isMore = [](const tinyobj::shape_t& shape) {
        return !shape.lines.indices.empty() || !shape.points.indices.empty();
    };
    if (std::any_of(parsed.shapes.begin(), parsed.shapes.end(), isMore))
        warnings.warn("lines and points are not drawn");
    return parsed;
}

/// All shapes as the limit surface of one cage, if that is asked for. Nothing where only the file itself asks for it
/// and there is no limit surface.
std::shared_ptr<Mesh> limitSurface(const ParsedObj& parsed, const Subdivision& subdivision, uint32_t fallback,
                                   FileWarnings& warnings, const std::stop_token& stop) {
    using Scheme = SubdivisionCage::Scheme;
    if (subdivision.scheme == SubdivisionScheme::None) return nullptr;
    const bool asked = subdivision.scheme != SubdivisionScheme::Auto;
    if (!asked && !parsed.scheme && !hasTags(parsed.shapes)) {
        warnOfOtherTags(parsed.shapes, warnings);
        return nullptr;
    }
    const Scheme scheme = subdivision.scheme == SubdivisionScheme::Bilinear ? Scheme::Bilinear
                          : asked                                           ? Scheme::CatmullClark
                                  : parsed.scheme.value_or(Scheme::CatmullClark);
    try {
        const SubdivisionCage cage = cageOf(parsed.attributes, parsed.shapes, scheme, fallback, warnings);
        auto mesh = std::make_shared<Mesh>(tessellate(cage, subdivision.rate, warnings.file(), stop).mesh);
        mesh->name = "surface";
        return mesh;
    } catch (const Error& error) {
        if (asked || error.kind() != ErrorKind::BadInput) throw;
        warnings.warnWhole(std::string(error.what()) + "; its polygons are shown as they are");
        return nullptr;
    }
}

/// The shapes as meshes, or the one that they are the cage of.
std::vector<std::shared_ptr<Mesh>> buildMeshes(const ParsedObj& parsed, const std::vector<Material>& materials,
                                               const Subdivision& subdivision, FileWarnings& warnings,
                                               const std::stop_token& stop) {
    const std::string& where = warnings.file();
    const uint32_t fallback = static_cast<uint32_t>(materials.size() - 1);
    std::vector<std::shared_ptr<Mesh>> meshes{limitSurface(parsed, subdivision, fallback, warnings, stop)};
    const bool subdivided = meshes.front() != nullptr;
    if (!subdivided) meshes.resize(parsed.shapes.size());
    parallelFor(
        static_cast<int64_t>(meshes.size()),
        [&](int64_t i) {
            std::shared_ptr<Mesh>& mesh = meshes[static_cast<size_t>(i)];
            if (!subdivided)
                mesh = std::make_shared<Mesh>(
                    meshFromShape(parsed.attributes, parsed.shapes[static_cast<size_t>(i)], fallback, where, stop));
            checkMesh(*mesh, where);
            const auto needsTangents = [&](uint32_t m) { return bool(materials[m].normalTexture); };
            const bool any = std::any_of(mesh->triangleMaterial.begin(), mesh->triangleMaterial.end(), needsTangents) ||
                             (mesh->triangleMaterial.empty() && needsTangents(mesh->material));
            if (any && !mesh->uv[0].empty() && !mesh->normals.empty()) computeTangents(*mesh);
        },
        stop);
    return meshes;
}

}  // namespace

Scene loadObj(const std::filesystem::path& path, MessageLog& log, const LoadOptions& options) {
    FileWarnings warnings(path.filename().string(), log);
    const std::string& where = warnings.file();
    const auto step = [&](float fraction, const char* what) {
        if (options.stop.stop_requested())
            throw Error(ErrorKind::Interrupted, {.what = "loading was stopped", .where = where});
        if (options.progress) options.progress(fraction, what);
    };
    step(0, "Reading geometry");
    const ParsedObj parsed = parse(path, warnings);
    const auto hasFaces = [](const tinyobj::shape_t& shape) { return !shape.mesh.num_face_vertices.empty(); };
    if (std::none_of(parsed.shapes.begin(), parsed.shapes.end(), hasFaces))
        throwBadInput({.what = "holds no faces", .where = where, .expected = "an OBJ with polygons"});
    step(0.4f, "Decoding textures");
    ObjImages images(path.parent_path(), warnings);
    Scene scene;
    scene.title = path.stem().string();
    scene.path = path.string();
    warnOfOtherTextures(parsed.materials, warnings);
    scene.materials = convertMaterials(parsed.materials, images, options.stop);

    step(0.7f, "Building meshes");
    const uint32_t fallback = static_cast<uint32_t>(scene.materials.size() - 1);
    const std::vector<std::shared_ptr<Mesh>> meshes =
        buildMeshes(parsed, scene.materials, options.subdivision, warnings, options.stop);
    step(0.9f, "Placing objects");
    bool usesFallback = false;
    for (size_t i = 0; i < meshes.size(); ++i) {
        if (meshes[i]->triangles.empty()) continue;
        Node node;
        node.name = meshes[i]->name.empty() ? "shape-" + std::to_string(i) : meshes[i]->name;
        Instance instance;
        instance.name = node.name;
        instance.node = static_cast<int>(scene.nodes.size());
        instance.mesh = meshes[i];
        const std::vector<uint32_t>& table = meshes[i]->triangleMaterial;
        usesFallback |= table.empty() ? meshes[i]->material == fallback
                                      : std::find(table.begin(), table.end(), fallback) != table.end();
        scene.nodes.push_back(std::move(node));
        scene.instances.push_back(std::move(instance));
    }
    if (!usesFallback && fallback > 0) scene.materials.pop_back();
    const uint64_t parts[2] = {parsed.digest, images.digest()};
    scene.contentDigest = digest({reinterpret_cast<const uint8_t*>(parts), sizeof(parts)});
    warnings.tellOfMore();
    step(1, "Loaded");
    return scene;
}

}  // namespace lumi
