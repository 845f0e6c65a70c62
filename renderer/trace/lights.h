#pragma once
#include <optional>
#include <span>
#include <vector>

#include "trace/alias_table.h"
#include "trace/environment.h"
#include "trace/light_receiver.h"
#include "trace/light_tree.h"
#include "trace/ray.h"
#include "trace/scene_tables.h"

namespace lumi {

struct LightLanes;
struct PlainLanes;

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

/// All lights of a posed scene: emissive triangles (an entry each), rectangles (by solid angle [Urena 2013]), disks and
/// triangles (by area), spheres (by the cone they fill), points, spots, directional lights (a cone if they have an
/// angle), and the environment.
///
/// One is chosen in proportion to power, or (LightSampling::Tree) by importance to the receiver: those at finite places
/// from a light tree, infinite ones by the irradiance they cause on it. Entries of finite lights come first.
class Lights {
public:
    /// Rebuilds in parallel what `posed` changed; `tables` is of the same scene and must outlive this.
    /// Throws Error(Resources) beyond the memory limit and Error(Interrupted) once stopped; it must be built anew then.
    void build(const PosedScene& posed, const SceneTables& tables, const std::stop_token& stop = {});

    size_t count() const { return entries_.size(); }
    bool empty() const { return picks_.empty(); }
    /// Can a continued path find light by itself (emitters with a body, the sky)?
    bool hittable() const { return hittable_; }
    /// Are there surfaces that emit: triangles or bodies?
    bool hasEmitters() const { return hasEmitters_; }
    /// Is there a light that only light samples find?
    bool hasDelta() const { return hasDelta_; }

    /// A light that was chosen for a receiver.
    struct Choice {
        uint32_t entry = kNone;
        float probability = 0;
    };
    static constexpr uint32_t kNone = ~0u;
    /// Chooses a light for each of the lanes by their random numbers lightX and lightY, and asks the caches for what
    /// samplePoint() will read of it. Receiver i is lane i's, and faces to the front.
    void choose(const PlainLanes& lanes, std::span<const LightReceiver> receivers, std::span<Choice> choices) const;
    /// A point of the chosen light by `u`. False if nothing can reach the receiver that way.
    bool samplePoint(const Choice& choice, const LightReceiver& receiver, Vec2 u, LightSample& out) const;

    /// samplePoint() for each of the lanes: the light's columns of `lanes`, pdf 0 where nothing can reach the receiver.
    /// The sky's radiance is 1, to be multiplied by what its place has. Choice i and receiver i are those of lane i.
    void samplePoints(std::span<const Choice> choices, std::span<const LightReceiver> receivers, LightLanes& lights,
                      PlainLanes& lanes) const;
    /// Is it without extent, so that no continued path finds it?
    bool isDelta(uint32_t entry) const;
    bool isSky(uint32_t entry) const { return !environment_.black() && entry + 1 == entries_.size(); }

    /// Chooses a light by `pick` and a point of it by `u`. False if nothing can reach the receiver that way.
    bool sample(const LightReceiver& receiver, Vec2 pick, Vec2 u, LightSample& out) const;

    /// The sample's radiance: sky is looked up here, so that samples that cannot contribute never wait for memory.
    Vec3 radiance(const LightSample& sample) const {
        return sample.sky ? environment_.radianceAt(sample.skyPlace) : sample.radiance;
    }

    /// Density with which sample() for `receiver` makes `direction`, which meets an emissive triangle at
    /// `hitPosition` (unit `hitNormal`; `area` of the triangle, 0 if it is not known) or a light's body.
    float pdfTriangle(uint32_t instance, uint32_t primitive, const LightReceiver& receiver, const Vec3& direction,
                      const Vec3& hitPosition, const Vec3& hitNormal, float area = 0) const;
    /// Asks for what pdfTriangle() of it reads first.
    void prefetchTriangle(uint32_t instance, uint32_t primitive) const {
        if (firstEntry_[instance] != kNone && !tree_.empty()) tree_.prefetch(firstEntry_[instance] + primitive);
    }
    float pdfBody(int body, const LightReceiver& receiver, const Vec3& direction, const Vec3& hitPosition) const;

    /// Radiance that a path finds that leaves the scene along `direction` at `time`: the sky, and directional lights
    /// with an angle unless `cameraRay` (they are not seen directly); weighted by `weight(pdf)` of the density of
    /// sample() for each, which is asked for `receiver` (null: nothing samples lights, weights are 1).
    template <class Weight>
    Vec3 escaped(const Vec3& direction, float time, bool cameraRay, const LightReceiver* receiver,
                 Weight&& weight) const;

    const EnvironmentLight& environment() const { return environment_; }
    /// Probability of choosing an entry for `receiver`; over all entries they add up to 1, or to less where lights were
    /// left that cannot reach it.
    float pickProbability(const LightReceiver& receiver, uint32_t entry) const;
    /// The entry of an emissive triangle, or -1.
    int entryOf(uint32_t instance, uint32_t primitive) const;
    /// And back: an entry's triangle, its instance and primitive alone; none if it is no triangle.
    std::optional<SurfacePoint> triangleOf(uint32_t entry) const;
    size_t byteCount() const;

private:
    /// The sky counts at least as this part of its mean: parts of it shine from behind the plane that faces away from
    /// it.
    static constexpr float kLeastSky = 0.05f;

    enum class Kind : uint8_t { Triangle, Body, Point, Directional, Environment };
    struct Entry {
        Kind kind = Kind::Triangle;
        uint32_t index = 0;  ///< into triangles_ (where it is the entry's own), bodies of the tables, points_, suns_
    };
    /// All that a sample of it reads, in one line of the cache.
    struct alignas(64) Triangle {
        /// Textured: emission or alpha, or the radiance depends on the direction.
        enum : uint32_t { kDoubleSided = 1, kMirrored = 2, kMoves = 4, kTextured = 8 };
        Vec3 corner, edge1, edge2;
        Vec3 radiance{0};  ///< unless textured
        uint32_t instance = 0, primitive = 0;
        float offset = 0;  ///< as Surface's
        uint32_t flags = 0;
    };
    struct Point {
        Vec3 position, axis, intensity;
        int track = -1;                                          ///< into tracks_ if it moves while the shutter is open
        float range = kInfinity, spotScale = 0, spotOffset = 1;  ///< angular fall-off: clamp(cos scale + offset)^2
    };
    struct Sun {
        Vec3 towards, radiance, irradiance;
        float oneMinusCos = 0;  ///< 0: a delta
        float sine = 0;         ///< of half its angle
        int track = -1;
    };
    /// What building collects.
    struct Collected {
        std::vector<float> weights;       ///< power, for each entry
        std::vector<LightBounds> bounds;  ///< for each entry at a finite place
    };

    void addTriangles(Collected& collected);
    /// As it is when the shutter opens.
    Triangle makeTriangle(uint32_t instance, uint32_t primitive) const;
    /// While the shutter is open, in square metres.
    float mostArea(const Triangle& triangle) const;
    /// Of all that it passes while the shutter is open.
    LightBounds boundsOf(const Triangle& triangle, float intensity) const;
    void addBodies(Collected& collected);
    void addPoints(const PosedScene& posed, Collected& collected);
    void addInfinite(const PosedScene& posed, Collected& collected);

    Choice choose(const LightReceiver& receiver, Vec2 pick) const;
    void chooseByImportance(const PlainLanes& lanes, std::span<const LightReceiver> receivers,
                            std::span<Choice> choices) const;
    /// What an infinite light weighs in the choice for each lane.
    void weighInfinite(uint32_t infinite, const PlainLanes& lanes, std::span<const LightReceiver> receivers,
                       float* weights) const;
    void prefetch(const Choice& choice) const;
    /// One of the infinite lights, which have `share` of the choice and the sum `elsewhere` of importances
    /// importanceOf(i).
    template <class Importance>
    Choice chosenInfinite(float u, float share, float elsewhere, Importance&& importanceOf) const;
    float infiniteImportance(const LightReceiver& receiver, uint32_t infinite) const;
    float infiniteImportance(const LightReceiver& receiver) const;

    static void placeTriangle(const Triangle& triangle, LightLanes& lights, int lane);
    static void placePoint(const Point& point, LightLanes& lights, int lane);
    static void placeSun(const Sun& sun, LightLanes& lights, int lane);
    uint32_t placeLight(const Choice& choice, Vec2 u, LightLanes& lights, int lane) const;
    bool sampleTriangle(const Triangle& triangle, const LightReceiver& receiver, Vec2 u, LightSample& out) const;
    bool sampleBody(const BodyRecord& body, const LightReceiver& receiver, Vec2 u, LightSample& out) const;
    bool samplePunctual(const Point& point, const LightReceiver& receiver, LightSample& out) const;
    bool sampleSun(const Sun& sun, float time, Vec2 u, LightSample& out) const;
    /// As they are at one time of the open shutter.
    Triangle triangleAt(const Triangle& triangle, float time) const;
    Mat4 frameAt(int track, float time) const;
    int addTrack(const std::vector<Mat4>& frames);
    Vec3 towards(const Sun& sun, float time) const {
        return sun.track < 0 ? sun.towards : unitOr(Vec3(frameAt(sun.track, time)[2]), sun.towards);
    }

    const SceneTables* tables_ = nullptr;
    std::vector<Entry> entries_;
    std::vector<Triangle> triangles_;  ///< of the first entries
    std::vector<Point> points_;
    std::vector<Sun> suns_;
    std::vector<std::vector<Mat4>> tracks_;  ///< frames of moving points and suns
    std::vector<uint32_t> firstTriangle_;    ///< of each instance, into triangleEntry_; kNone: it does not emit
    std::vector<uint32_t>
        firstEntry_;  ///< of each instance whose triangles all emit: entries in their order; else kNone
    std::vector<uint32_t> triangleEntry_;  ///< entry of each triangle of emitting instances, kNone if it does not emit
    uint32_t firstBody_ = 0;               ///< entry
    uint32_t finiteCount_ = 0;             ///< entries before this are in the tree, in its order
    AliasTable picks_;
    LightTree tree_;
    EnvironmentLight environment_;
    bool hittable_ = false, hasEmitters_ = false, hasDelta_ = false;
};

template <class Importance>
Lights::Choice Lights::chosenInfinite(float u, float share, float elsewhere, Importance&& importanceOf) const {
    // No branch hangs on the random number.
    Choice chosen;
    float rest = u * elsewhere, importance = 0;
    bool open = true;
    for (uint32_t i = 0; finiteCount_ + i < entries_.size(); ++i) {
        const float own = importanceOf(i);
        const bool takes = open & (own > 0);
        chosen.entry = takes ? finiteCount_ + i : chosen.entry;
        importance = takes ? own : importance;
        open &= !(takes & (rest < own));
        rest -= takes ? own : 0.0f;
    }
    chosen.probability = importance > 0 ? share * importance / elsewhere : 0.0f;
    return chosen;
}

template <class Weight>
Vec3 Lights::escaped(const Vec3& direction, float time, bool cameraRay, const LightReceiver* receiver,
                     Weight&& weight) const {
    Vec3 sum(0);
    const auto pick = [&](size_t infinite) {
        return receiver ? pickProbability(*receiver, finiteCount_ + static_cast<uint32_t>(infinite)) : 0.0f;
    };
    if (!environment_.black()) {
        const float chosen = pick(suns_.size());
        sum += environment_.radiance(direction) * weight(chosen > 0 ? chosen * environment_.pdf(direction) : 0.0f);
    }
    if (cameraRay) return sum;
    for (size_t i = 0; i < suns_.size(); ++i) {
        const Sun& sun = suns_[i];
        if (sun.oneMinusCos <= 0) continue;
        // 1 - cos of the angle between two unit vectors, without cancellation.
        const Vec3 difference = direction - towards(sun, time);
        if (0.5f * glm::dot(difference, difference) > sun.oneMinusCos) continue;
        sum += sun.radiance * weight(pick(i) / (2 * kPi * sun.oneMinusCos));
    }
    return sum;
}

}  // namespace lumi
