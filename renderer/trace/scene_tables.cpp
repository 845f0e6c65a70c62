#include "trace/scene_tables.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "trace/texture_view.h"

namespace lumi {
namespace {

template <class T>
const T* dataOrNull(const std::vector<T>& values) {
    return values.empty() ? nullptr : values.data();
}

MaterialRecord makeMaterial(const Material& m) {
    MaterialRecord r;
    r.source = &m;
    const auto mark = [&](const Texture& texture, uint32_t flag) { r.textures |= texture ? flag : 0u; };
    mark(m.baseColorTexture, MaterialRecord::kBaseColor);
    mark(m.metallicRoughnessTexture, MaterialRecord::kMetallicRoughness);
    mark(m.normalTexture, MaterialRecord::kNormal);
    mark(m.emissionTexture, MaterialRecord::kEmission);
    mark(m.specularTexture, MaterialRecord::kSpecular);
    mark(m.specularColorTexture, MaterialRecord::kSpecularColor);
    mark(m.transmissionTexture, MaterialRecord::kTransmission);
    r.solid = m.isSolid();
    r.thinWall = m.transmission > 0 && !r.solid;
    r.layered = m.isLayered();
    r.doubleSided = m.doubleSided;
    r.emits = m.emits();
    r.coatedEmission = r.emits && m.clearcoat > 0;
    r.unlit = m.unlit;
    r.metallic = m.metallic, r.roughness = m.roughness, r.ior = m.ior, r.specular = m.specular;
    r.transmission = m.transmission;
    r.baseColor = m.baseColor, r.specularColor = m.specularColor, r.emission = m.emission;
    // Light takes on attenuationColor in attenuationDistance: exp(-sigma d) = color.
    if (r.solid && std::isfinite(m.attenuationDistance) && m.attenuationDistance > 0)
        for (int c = 0; c < 3; ++c)
            r.absorption[c] = -std::log(std::clamp(m.attenuationColor[c], 1e-6f, 1.0f)) / m.attenuationDistance;
    return r;
}

bool shareTaps(const Texture& a, const Texture& b) {
    return a.wrapU == b.wrapU && a.wrapV == b.wrapV && a.offset == b.offset && a.scale == b.scale &&
           a.rotation == b.rotation && a.image->levels.front().extent == b.image->levels.front().extent &&
           a.image->levels.size() == b.image->levels.size();
}

/// Is the material plain? Then its textures are added.
void addViews(MaterialRecord& r, std::vector<TextureView>& textures) {
    constexpr uint32_t kViewed =
        MaterialRecord::kBaseColor | MaterialRecord::kMetallicRoughness | MaterialRecord::kNormal;
    if (r.layered || r.transmission > 0 ||
        (r.textures & ~(kViewed | MaterialRecord::kEmission | MaterialRecord::kTransmission)) != 0)
        return;
    const Texture* const all[] = {&r.source->baseColorTexture, &r.source->metallicRoughnessTexture,
                                  &r.source->normalTexture};
    const Texture* first = nullptr;
    r.sharedTaps = true;
    for (const Texture* t : all) {
        if (!*t) continue;
        if (!first) first = t;
        if (!hasTextureView(*t) || (t->uvSet == 1) != (first->uvSet == 1)) return;
        r.sharedTaps &= shareTaps(*first, *t);
    }
    r.plain = true;
    r.uvSet = first && first->uvSet == 1 ? 1 : 0;
    for (int i = 0; i < MaterialRecord::kViews; ++i) {
        if (!*all[i]) continue;
        r.views[i] = static_cast<int>(textures.size());
        textures.push_back(makeTextureView(*all[i]));
    }
}

float largestCoordinate(const Vec3* positions, size_t count) {
    float largest = 0;
    for (size_t i = 0; i < count; ++i)
        for (int c = 0; c < 3; ++c) {
            const float a = std::abs(positions[i][c]);
            if (a > largest && std::isfinite(a)) largest = a;
        }
    return largest;
}

InstanceRecord makeInstance(const PosedScene& posed, const EmbreeScene& embree, uint32_t index) {
    const Instance& instance = posed.scene->instances[index];
    const PosedInstance& pose = posed.instances[index];
    InstanceRecord r;
    r.worldFromObject = pose.worldFromObject;
    r.normalFromObject = pose.normalFromObject();
    r.mirrored = isMirroring(pose.worldFromObject);
    r.track = pose.track();
    r.carried = r.track && embree.isCarried(index);
    if (!instance.mesh) return r;
    const Mesh& mesh = *instance.mesh;
    r.triangles = dataOrNull(mesh.triangles);
    r.triangleCount = static_cast<uint32_t>(mesh.triangles.size());
    r.normals = r.restNormals = dataOrNull(mesh.normals);
    r.tangents = dataOrNull(mesh.tangents);
    r.restPositions = dataOrNull(mesh.positions);
    r.uv[0] = dataOrNull(mesh.uv[0]), r.uv[1] = dataOrNull(mesh.uv[1]);
    r.colours = dataOrNull(mesh.colours);
    if (instance.material >= 0) r.material = static_cast<uint32_t>(instance.material);
    else r.material = mesh.material, r.triangleMaterial = dataOrNull(mesh.triangleMaterial);
    if (const Vec3* world = embree.worldPositions(index)) {
        r.positions = world;
        r.inWorld = true;
        return r;
    }
    r.positions = dataOrNull(mesh.positions);
    size_t count = mesh.positions.size();
    if (pose.deformed) {
        r.positions = dataOrNull(pose.deformed->positions);
        if (!pose.deformed->normals.empty()) r.normals = pose.deformed->normals.data();
        r.deformedTangents = dataOrNull(pose.deformed->tangents);
        r.deformedBitangents = dataOrNull(pose.deformed->bitangents);
        r.turned = pose.deformed->isMirrored();
        r.mirrored = r.mirrored != r.turned;
        count = pose.deformed->positions.size();
    }
    float largestRow = 0;
    const auto addRows = [&](const Mat4& m) {
        for (int row = 0; row < 3; ++row)
            largestRow = std::max(largestRow, std::abs(m[0][row]) + std::abs(m[1][row]) + std::abs(m[2][row]));
    };
    addRows(r.worldFromObject);
    if (r.track)
        for (const Mat4& m : r.track->worldFromObject) addRows(m);
    const bool known = !pose.deformed && posed.meshBounds && index < posed.meshBounds->size();
    const Vec3 corners[] = {known ? (*posed.meshBounds)[index].lower : Vec3(0),
                            known ? (*posed.meshBounds)[index].upper : Vec3(0)};
    r.objectScale = largestRow * (known ? largestCoordinate(corners, 2) : largestCoordinate(r.positions, count));
    return r;
}

}  // namespace

SceneTables makeSceneTables(const PosedScene& posed, const EmbreeScene& embree) {
    const Scene& scene = *posed.scene;
    SceneTables tables;
    tables.instances.resize(scene.instances.size());
    parallelRanges(static_cast<int64_t>(scene.instances.size()), 16, [&](int64_t begin, int64_t end) {
        for (int64_t i = begin; i < end; ++i)
            tables.instances[static_cast<size_t>(i)] = makeInstance(posed, embree, static_cast<uint32_t>(i));
    });
    for (const Material& material : scene.materials) {
        tables.materials.push_back(makeMaterial(material));
        tables.thinWalls |= tables.materials.back().thinWall;
        tables.absorbs |= !isBlack(tables.materials.back().absorption);
    }
    static const Material kNone;
    if (tables.materials.empty()) tables.materials.push_back(makeMaterial(kNone));
    for (MaterialRecord& material : tables.materials) addViews(material, tables.textures);
    for (InstanceRecord& r : tables.instances) {
        // An index out of range shades with the first material.
        if (r.material >= tables.materials.size()) r.material = 0;
    }
    for (size_t i = 0; i < scene.lights.size(); ++i) {
        if (!hasBody(scene.lights[i].type)) continue;
        BodyRecord body;
        body.light = static_cast<int>(i);
        body.shape = lightShape(scene.lights[i], posed.lights[i].worldFromLight);
        body.previousShape = lightShape(scene.lights[i], posed.lights[i].worldFromLightPrevious);
        body.shutterShapes = lightShapes(scene.lights[i], posed.lights[i].track);
        body.previousShutterShapes = lightShapes(scene.lights[i], posed.lights[i].previousTrack);
        for (size_t k = 0; k < scene.instances.size(); ++k)
            if (scene.instances[k].light == static_cast<int>(i)) {
                body.instance = static_cast<uint32_t>(k);
                tables.instances[k].body = static_cast<int>(tables.bodies.size());
            }
        tables.bodies.push_back(body);
    }
    return tables;
}

size_t SceneTables::byteCount() const {
    return instances.capacity() * sizeof(InstanceRecord) + materials.capacity() * sizeof(MaterialRecord) +
           bodies.capacity() * sizeof(BodyRecord) + textures.capacity() * sizeof(TextureView);
}

}  // namespace lumi
