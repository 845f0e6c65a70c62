#include <cmath>
#include <vector>

#include "base/memory.h"
#include "base/parallel.h"
#include "math/hash.h"
#include "math/warp.h"
#include "scene/procedural/primitives.h"

namespace lumi {
namespace {

/// Curled tubes that grow from a core sphere: thin geometry with depth complexity, hard on filters and on history.
class Hairball : public Procedural {
public:
    void describe(ParameterVisitor& v) override {
        v.integer("strands", strands_,
                  {.label = "Strands",
                   .min = 1,
                   .max = 200000,
                   .scale = Scale::Log,
                   .help = "Number of strands.",
                   .redo = Redo::Build});
        v.number("radius", radius_,
                 {.label = "Radius",
                  .min = 1e-3,
                  .max = 1e3,
                  .scale = Scale::Log,
                  .unit = "m",
                  .help = "Distance from the centre that strands reach.",
                  .redo = Redo::Build});
        v.number("core", core_,
                 {.label = "Core",
                  .min = 0,
                  .max = 0.95,
                  .help = "Share of the radius at which strands begin.",
                  .redo = Redo::Build});
        v.number("thickness", thickness_,
                 {.label = "Thickness",
                  .min = 1e-5,
                  .max = 1,
                  .scale = Scale::Log,
                  .unit = "m",
                  .help = "Diameter at the root; tips are a quarter of it.",
                  .redo = Redo::Build});
        v.number("curl", curl_,
                 {.label = "Curl",
                  .min = 0,
                  .max = 4,
                  .help = "How far strands wander off their radius; 0 is straight.",
                  .redo = Redo::Build});
        v.integer(
            "segments", segments_,
            {.label = "Segments", .min = 1, .max = 64, .help = "Straight pieces of a strand.", .redo = Redo::Build});
        v.integer("sides", sides_,
                  {.label = "Sides", .min = 3, .max = 16, .help = "Facets around a strand.", .redo = Redo::Build});
        v.integer("seed", seed_,
                  {.label = "Seed", .min = 0, .max = 1e6, .help = "Another arrangement.", .redo = Redo::Build});
    }
    ProceduralResult build() const override;

private:
    std::vector<Vec3> strandPoints(uint32_t strand) const;
    void writeStrand(uint32_t strand, Mesh& mesh) const;

    int strands_ = 2000;
    float radius_ = 0.5f, core_ = 0.1f, thickness_ = 0.004f, curl_ = 1;
    int segments_ = 12, sides_ = 3, seed_ = 1;
};

float randomUnit(uint32_t key, uint32_t dimension) { return unitFloat(hashCombine(key, dimension)); }

/// Centre line of a strand: outwards along a random direction that turns smoothly as it goes.
std::vector<Vec3> Hairball::strandPoints(uint32_t strand) const {
    const uint32_t key = hashCombine(static_cast<uint32_t>(seed_), strand);
    const Vec3 direction = sampleSphere({randomUnit(key, 0), randomUnit(key, 1)});
    const Frame frame(direction);
    const float phase = 2 * kPi * randomUnit(key, 2), turns = 0.5f + 1.5f * randomUnit(key, 3);
    const float length = 0.75f + 0.25f * randomUnit(key, 4);
    std::vector<Vec3> points(static_cast<size_t>(segments_ + 1));
    for (int i = 0; i <= segments_; ++i) {
        const float t = static_cast<float>(i) / static_cast<float>(segments_);
        const float along = glm::mix(core_, length, t);
        const float swing = 0.35f * curl_ * t * (1 - core_), angle = phase + 2 * kPi * turns * t;
        const Vec3 p = frame.toWorld({swing * std::cos(angle), swing * std::sin(angle), along});
        // Swinging out must not leave the ball.
        points[static_cast<size_t>(i)] = radius_ * along * glm::normalize(p);
    }
    return points;
}

void Hairball::writeStrand(uint32_t strand, Mesh& mesh) const {
    const std::vector<Vec3> points = strandPoints(strand);
    const size_t sides = static_cast<size_t>(sides_), rings = points.size();
    const size_t firstVertex = strand * (rings * sides + 2);
    const size_t firstTriangle = strand * 2 * sides * rings;
    const auto ringVertex = [&](size_t ring, size_t side) {
        return static_cast<uint32_t>(firstVertex + ring * sides + side % sides);
    };
    const auto tangentAt = [&](size_t i) {
        return glm::normalize(points[std::min(i + 1, rings - 1)] - points[i > 0 ? i - 1 : 0]);
    };
    // A frame that turns as little as possible from ring to ring, so that the tube does not twist.
    Vec3 across = Frame(tangentAt(0)).x;
    size_t triangle = firstTriangle;
    for (size_t i = 0; i < rings; ++i) {
        const Vec3 tangent = tangentAt(i);
        across = glm::normalize(across - tangent * glm::dot(across, tangent));
        const Vec3 other = glm::cross(tangent, across);
        const float t = static_cast<float>(i) / static_cast<float>(rings - 1);
        const float ringRadius = 0.5f * thickness_ * glm::mix(1.0f, 0.25f, t);
        for (size_t side = 0; side < sides; ++side) {
            const float angle = 2 * kPi * static_cast<float>(side) / static_cast<float>(sides);
            const Vec3 normal = across * std::cos(angle) + other * std::sin(angle);
            const uint32_t v = ringVertex(i, side);
            mesh.positions[v] = points[i] + ringRadius * normal;
            mesh.normals[v] = normal;
            mesh.uv[0][v] = {static_cast<float>(side) / static_cast<float>(sides), t};
            if (i + 1 < rings) {
                const uint32_t a = v, b = ringVertex(i, side + 1), c = ringVertex(i + 1, side + 1);
                mesh.triangles[triangle++] = {a, b, c};
                mesh.triangles[triangle++] = {a, c, ringVertex(i + 1, side)};
            }
        }
    }
    // Both ends are closed by a fan around a point on the centre line.
    const auto root = static_cast<uint32_t>(firstVertex + rings * sides), tip = root + 1;
    for (const bool atTip : {false, true}) {
        const uint32_t end = atTip ? tip : root;
        const size_t ring = atTip ? rings - 1 : 0;
        mesh.positions[end] = points[ring];
        mesh.normals[end] = atTip ? tangentAt(ring) : -tangentAt(ring);
        mesh.uv[0][end] = {0.5f, atTip ? 1.0f : 0.0f};
        for (size_t side = 0; side < sides; ++side) {
            const uint32_t a = ringVertex(ring, side), b = ringVertex(ring, side + 1);
            mesh.triangles[triangle++] = atTip ? UVec3(a, b, end) : UVec3(b, a, end);
        }
    }
}

ProceduralResult Hairball::build() const {
    const size_t rings = static_cast<size_t>(segments_ + 1), sides = static_cast<size_t>(sides_);
    const size_t strands = static_cast<size_t>(strands_);
    checkMemory("hairball", strands * sides * rings * (2 * sizeof(Vec3) + sizeof(Vec2) + 2 * sizeof(UVec3)));
    Mesh mesh;
    mesh.name = "hairball";
    mesh.positions.resize(strands * (rings * sides + 2));
    mesh.normals.resize(mesh.positions.size());
    mesh.uv[0].resize(mesh.positions.size());
    mesh.triangles.resize(strands * 2 * sides * rings);
    parallelFor(strands_, [&](int64_t strand) { writeStrand(static_cast<uint32_t>(strand), mesh); });
    return singleMesh(std::move(mesh));
}

}  // namespace

std::unique_ptr<Procedural> makeHairball() { return std::make_unique<Hairball>(); }

}  // namespace lumi
