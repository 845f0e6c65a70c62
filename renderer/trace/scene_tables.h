#pragma once
#include <array>
#include <vector>

#include "scene/posed_scene.h"
#include "trace/embree_scene.h"
#include "trace/light_shape.h"

namespace lumi {

/// What shading reads of an instance, in one place; pointers are into the posed scene (or Embree's world vertices).
struct InstanceRecord {
    const UVec3* triangles = nullptr;
    const Vec3* positions = nullptr;    ///< object space, or world space if `inWorld`
    const Vec3* normals = nullptr;      ///< object space, posed; null: flat
    const Vec3* restNormals = nullptr;  ///< of the mesh, object space
    const Vec3* restPositions = nullptr;
    const Vec4* tangents = nullptr;            ///< of the mesh: directions at rest, and handedness
    const Vec3* deformedTangents = nullptr;    ///< posed directions, if the pose has them
    const Vec3* deformedBitangents = nullptr;  ///< the same across, if the pose has them; see DeformedVertices
    const Vec2* uv[2] = {nullptr, nullptr};
    const Vec4* colours = nullptr;
    const uint32_t* triangleMaterial = nullptr;  ///< null: `material` for all
    uint32_t material = 0;
    uint32_t triangleCount = 0;
    int body = -1;  ///< index into SceneTables::shapes if this is the body of a light
    bool inWorld = false;
    bool carried = false;   ///< while the shutter is open its vertices go as carried_steps.h says
    bool turned = false;    ///< joints mirror it: front faces turn clockwise in the space of `positions`
    bool mirrored = false;  ///< front faces turn clockwise in the world
    float objectScale = 0;  ///< largest |coordinate| that the transform's products reach: bounds rounding errors
    Mat4 worldFromObject{1};
    Mat3 normalFromObject{1};
    const ShutterTrack* track = nullptr;  ///< where it is while the shutter is open; null: as above all the time

    /// Triangles that stay where they are.
    bool still() const { return body < 0 && !track; }
    uint32_t materialOf(uint32_t primitive) const { return triangleMaterial ? triangleMaterial[primitive] : material; }
};

/// An 8-bit texture that is filtered linearly, ready for lookups: see texture_view.h.
struct TextureView {
    struct Level {
        const uint8_t* bytes = nullptr;  ///< RGBA
        int width = 0, height = 0;
    };
    static constexpr int kMostLevels = 17;
    std::array<Level, kMostLevels> levels;
    int levelCount = 0;
    Wrap wrapU = Wrap::Repeat, wrapV = Wrap::Repeat;
    const float* decode = nullptr;         ///< linear values of the RGB codes; null: they are linear
    Vec2 uvX{1, 0}, uvY{0, 1}, offset{0};  ///< rows of the map from mesh coordinates
    float texelsPerUnit = 1;               ///< of mesh coordinates, level 0
};

/// A material without what only its textures need.
struct MaterialRecord {
    enum : uint32_t {
        kBaseColor = 1,
        kMetallicRoughness = 2,
        kNormal = 4,
        kEmission = 8,
        kSpecular = 16,
        kSpecularColor = 32,
        kTransmission = 64
    };
    uint32_t textures = 0;  ///< which of the above are present
    bool solid = false, doubleSided = true, emits = false;
    bool unlit = false;           ///< the instance's colours multiply the emission
    bool coatedEmission = false;  ///< it emits through a clearcoat
    bool thinWall = false;        ///< it transmits, and is no solid
    bool layered = false;         ///< the source's clearcoat, sheen, anisotropy or iridescence take part
    float metallic = 0, roughness = 0.5f, ior = 1.5f, specular = 1, transmission = 0;
    Vec3 baseColor{1}, specularColor{1}, emission{0};
    Vec3 absorption{0};  ///< 1/m inside a solid (Beer-Lambert)
    const Material* source = nullptr;

    /// Neither layers nor transmission, and no textures but emission's and the three below, all of one uv set: vertices
    /// on it are shaded by kernels.
    bool plain = false;
    bool sharedTaps = false;  ///< the three are alike but for their texels
    int uvSet = 0;
    enum View { kBaseColorView, kMetallicRoughnessView, kNormalView, kViews };
    int views[kViews] = {-1, -1, -1};  ///< into SceneTables::textures; -1: no such texture
};

/// A light with a body, by index into Scene::lights.
struct BodyRecord {
    LightShape shape, previousShape;
    std::vector<LightShape> shutterShapes,
        previousShutterShapes;  ///< at moments of the open shutter; empty: it is still
    int light = -1;
    uint32_t instance = kNone;  ///< that shows it; kNone: it cannot be hit
    static constexpr uint32_t kNone = ~0u;

    LightShape at(float time) const { return shutterShapes.empty() ? shape : shapeAt(shutterShapes, time); }
    LightShape previousAt(float time) const {
        return previousShutterShapes.empty() ? previousShape : shapeAt(previousShutterShapes, time);
    }
};

/// Flat tables of a posed scene.
struct SceneTables {
    std::vector<InstanceRecord> instances;
    std::vector<MaterialRecord> materials;
    std::vector<BodyRecord> bodies;
    std::vector<TextureView> textures;
    bool thinWalls = false;  ///< of some material
    bool absorbs = false;    ///< some solid
    size_t byteCount() const;
};

SceneTables makeSceneTables(const PosedScene& posed, const EmbreeScene& embree);

}  // namespace lumi
