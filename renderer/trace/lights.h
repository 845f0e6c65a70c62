#pragma once
#include <vector>

#include "trace/alias_table.h"
#include "trace/environment.h"
#include "trace/ray.h"
#include "trace/scene_tables.h"

namespace lumi {

/// A point (or direction) of a light as chosen for a shading point.
struct LightSample {
    Vec3 direction{0};   ///< unit, from the shading point
    float distance = 0;  ///< metres; +inf for infinite lights
    Vec3 target{0};      ///< where a shadow ray ends: the light's point moved off its surface (finite lights)
    Vec2 skyPlace{0};    ///< of the sky's samples: their radiance is looked up by Lights::radiance()
    bool sky = false;
    Vec3 radiance{0};  ///< towards the shading point; for lights without extent radiance times solid angle
    float pdf = 0;     ///< per solid angle, choice of the light included; for lights without extent of the choice alone
    bool delta = false;     ///< without extent: no other technique finds it
    bool hittable = false;  ///< continued paths find it too
    int light = -1;         ///< entry
    Vec3 position{0};       ///< the light's point; for infinite lights the direction
};

/// All lights of a posed scene, drawn in proportion to power: emissive triangles (an entry each), rectangles (by solid
/// angle [Urena 2013]), disks and triangles (by area), spheres (by the cone they fill), points, spots, directional
/// lights (a cone if they have an angle), and the environment.
class Lights {
public:
    /// Rebuilds in parallel what `posed` changed; `tables` is of the same scene and must outlive this.
    void build(const PosedScene& posed, const SceneTables& tables);

    size_t count() const { return entries_.size(); }
    bool empty() const { return picks_.empty(); }
    /// Can a continued path find light by itself (emitters with a body, the sky)?
    bool hittable() const { return hittable_; }
    /// Are there surfaces that emit: triangles or bodies?
    bool hasEmitters() const { return hasEmitters_; }
    /// Is there a light that only light samples find?
    bool hasDelta() const { return hasDelta_; }

    /// Chooses a light by `pick` and a point of it by `u`. False if nothing can reach `position` that way.
    bool sample(const Vec3& position, Vec2 pick, Vec2 u, LightSample& out) const;

    /// The sample's radiance: sky is looked up here, so that samples that cannot contribute never wait for memory.
    Vec3 radiance(const LightSample& sample) const {
        return sample.sky ? environment_.radianceAt(sample.skyPlace) : sample.radiance;
    }

    /// Density with which sample() from `position` makes `direction`, which meets an emissive triangle at
    /// `hitPosition` (unit `hitNormal`) or a light's body.
    float pdfTriangle(uint32_t instance, uint32_t primitive, const Vec3& position, const Vec3& direction,
                      const Vec3& hitPosition, const Vec3& hitNormal) const;
    float pdfBody(int body, const Vec3& position, const Vec3& direction, const Vec3& hitPosition) const;

    /// Radiance that a path finds that leaves the scene along `direction`: the sky, and directional lights with an
    /// angle unless `cameraRay` (they are not seen directly); with the density of sample() for each summed MIS-weighted
    /// by `weight(pdf)`.
    template <class Weight>
    Vec3 escaped(const Vec3& direction, bool cameraRay, Weight&& weight) const;

    const EnvironmentLight& environment() const { return environment_; }
    /// Probability of choosing an entry.
    float pickProbability(uint32_t entry) const { return picks_.probability(entry); }
    /// The entry of an emissive triangle, or -1.
    int entryOf(uint32_t instance, uint32_t primitive) const;
    size_t byteCount() const;

private:
    enum class Kind : uint8_t { Triangle, Body, Point, Directional, Environment };
    struct Entry {
        Kind kind = Kind::Triangle;
        uint32_t index = 0;  ///< into triangles_, bodies of the tables, points_, suns_
    };
    struct Triangle {
        Vec3 corner, edge1, edge2;
        uint32_t instance = 0, primitive = 0;
    };
    struct Point {
        Vec3 position, axis, intensity;
        float range = kInfinity, spotScale = 0, spotOffset = 1;  ///< angular fall-off: clamp(cos scale + offset)^2
    };
    struct Sun {
        Vec3 towards, radiance, irradiance;
        float oneMinusCos = 0;  ///< 0: a delta
        int entry = -1;
    };

    void addTriangles(std::vector<float>& weights);
    void addShapedAndPunctual(const PosedScene& posed, std::vector<float>& weights);
    bool sampleTriangle(const Triangle& triangle, const Vec3& position, Vec2 u, LightSample& out) const;
    bool sampleBody(const BodyRecord& body, const Vec3& position, Vec2 u, LightSample& out) const;
    bool samplePoint(const Point& point, const Vec3& position, LightSample& out) const;
    bool sampleSun(const Sun& sun, Vec2 u, LightSample& out) const;

    const SceneTables* tables_ = nullptr;
    std::vector<Entry> entries_;
    std::vector<Triangle> triangles_;
    std::vector<Point> points_;
    std::vector<Sun> suns_;
    std::vector<uint32_t> firstTriangle_;  ///< of each instance, into triangleEntry_; kNone: it does not emit
    std::vector<uint32_t> triangleEntry_;  ///< entry of each triangle of emitting instances, kNone if it does not emit
    std::vector<uint32_t> bodyEntry_;
    AliasTable picks_;
    EnvironmentLight environment_;
    int environmentEntry_ = -1;
    bool hittable_ = false, hasEmitters_ = false, hasDelta_ = false;
    static constexpr uint32_t kNone = ~0u;
};

template <class Weight>
Vec3 Lights::escaped(const Vec3& direction, bool cameraRay, Weight&& weight) const {
    Vec3 sum(0);
    if (!environment_.black()) {
        const float pdf = environmentEntry_ >= 0 ? picks_.probability(static_cast<uint32_t>(environmentEntry_)) : 0;
        sum += environment_.radiance(direction) * weight(pdf > 0 ? pdf * environment_.pdf(direction) : 0.0f);
    }
    if (cameraRay) return sum;
    for (const Sun& sun : suns_) {
        if (sun.oneMinusCos <= 0) continue;
        // 1 - cos of the angle between two unit vectors, without cancellation.
        const Vec3 difference = direction - sun.towards;
        if (0.5f * glm::dot(difference, difference) > sun.oneMinusCos) continue;
        const float pick = sun.entry >= 0 ? picks_.probability(static_cast<uint32_t>(sun.entry)) : 0;
        sum += sun.radiance * weight(pick / (2 * kPi * sun.oneMinusCos));
    }
    return sum;
}

}  // namespace lumi
