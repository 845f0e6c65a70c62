#include <algorithm>

#include "scene/procedural/creature_skeleton.h"

namespace lumi {
namespace {

using namespace creature;

constexpr uint32_t kBack = 0, kEyes = 1, kPupils = 2, kClaws = 3;

/// A long-necked, long-tailed creature of `length` metres that walks on the spot towards +Z: a skinned mesh over
/// 21 joints, with one looping gait.
class Creature final : public Procedural {
public:
    void describe(ParameterVisitor& v) override {
        describeLength(v, "length", length_, "Length", 0.05, 20, "From nose to tail");
        v.number("period", gait_.period,
                 {.label = "Period",
                  .min = 0.1,
                  .max = 20,
                  .unit = "s",
                  .help = "Time of one gait cycle",
                  .redo = Redo::Build});
        v.number(
            "phase", gait_.phase,
            {.label = "Phase", .min = 0, .max = 1, .help = "Where in the cycle the gait starts", .redo = Redo::Build});
        v.number("stride", gait_.strideDeg,
                 {.label = "Stride",
                  .min = 0,
                  .max = 45,
                  .unit = "deg",
                  .help = "Half the angle through which the legs swing",
                  .redo = Redo::Build});
        v.colour("back", back_, {.label = "Back", .help = "Colour of back and legs", .redo = Redo::Build});
        v.colour("belly", belly_, {.label = "Belly", .help = "Colour of the underside", .redo = Redo::Build});
        v.colour("stripes", stripes_, {.label = "Stripes", .help = "Colour of stripes and feet", .redo = Redo::Build});
        v.colour("crest", crest_, {.label = "Crest", .help = "Colour of the plates", .redo = Redo::Build});
        describeSeed(v, seed_);
    }

    ProceduralResult build() const override {
        ProceduralResult result;
        result.slots = {opaqueSlot("skin", {1, 1, 1}, 0.45f), opaqueSlot("eyes", {0.9f, 0.88f, 0.8f}, 0.1f),
                        opaqueSlot("pupils", {0.01f, 0.01f, 0.012f}, 0.05f),
                        opaqueSlot("claws", {0.12f, 0.09f, 0.07f}, 0.3f)};
        addSkeleton(result, length_);
        addGait(result, length_, gait_);
        Mesh mesh;
        std::vector<Influences> influences;
        addBody(mesh, influences);
        for (int leg = 0; leg < kLegs; ++leg) addLeg(mesh, influences, leg);
        addFace(mesh, influences);
        addCrest(mesh, influences);
        for (Vec3& p : mesh.positions) p *= length_;
        for (const Influences& w : influences) addInfluences(mesh.skin, w);
        ProceduralPart part;
        part.mesh = std::make_shared<const Mesh>(std::move(mesh));
        part.node = 0;
        part.skin = 0;
        result.parts.push_back(std::move(part));
        return result;
    }

private:
    /// Appends a part whose vertices are moved by what `weigh` says for each position.
    static void addSkinned(Mesh& mesh, std::vector<Influences>& influences, const Mesh& part, uint32_t slot,
                           const Vec3& colour, const std::function<Influences(const Vec3&)>& weigh) {
        Mesh painted = part;
        if (painted.colours.empty()) paint(painted, colour);
        tidy(painted);
        append(mesh, painted, slot);
        for (const Vec3& p : painted.positions) influences.push_back(weigh(p));
    }

    static std::vector<Vec3> spineCurve(int count) {
        return curveThrough(
            {Vec3(0, 0.385f, -0.80f), Vec3(0, 0.37f, -0.67f), Vec3(0, 0.38f, -0.55f), Vec3(0, 0.41f, -0.42f),
             Vec3(0, 0.45f, -0.28f), Vec3(0, 0.47f, -0.12f), Vec3(0, 0.47f, 0.05f), Vec3(0, 0.50f, 0.18f),
             Vec3(0, 0.59f, 0.28f), Vec3(0, 0.70f, 0.33f), Vec3(0, 0.80f, 0.375f), Vec3(0, 0.835f, 0.43f),
             Vec3(0, 0.825f, 0.50f), Vec3(0, 0.815f, 0.545f)},
            count);
    }

    /// Tail, trunk, neck and head are one tube around the spine.
    void addBody(Mesh& mesh, std::vector<Influences>& influences) const {
        constexpr int kRings = 110;
        const std::vector<Vec3> path = spineCurve(kRings);
        const std::vector<Vec3> shape = curveThrough(
            {Vec3(0.008f), Vec3(0.026f), Vec3(0.040f), Vec3(0.062f), Vec3(0.100f), Vec3(0.142f), Vec3(0.150f),
             Vec3(0.122f), Vec3(0.076f), Vec3(0.056f), Vec3(0.058f), Vec3(0.074f), Vec3(0.060f), Vec3(0.036f)},
            kRings);
        std::vector<float> radii;
        for (const Vec3& r : shape) radii.push_back(r.x);
        Mesh body = tube(path, radii, 36);
        std::vector<float> place;
        // uv.y of a tube is its length along the path, which orders the rings exactly.
        float whole = 0;
        for (const Vec2& uv : body.uv[0]) whole = std::max(whole, uv.y);
        body.colours.clear();
        for (size_t i = 0; i < body.positions.size(); ++i) {
            const float s = body.uv[0][i].y / whole;
            place.push_back(s);
            body.colours.push_back(Vec4(skinColour(body.positions[i], body.normals[i], s), 1));
        }
        append(mesh, body, kBack);
        for (const float s : place) influences.push_back(alongSpine(s));
    }

    /// Darker, striped back and a pale belly.
    Vec3 skinColour(const Vec3& p, const Vec3& n, float s) const {
        const auto seed = static_cast<uint32_t>(seed_);
        const float up = n.y + 0.25f * valueNoise(p * 9.0f, seed);
        const float band = glm::smoothstep(0.1f, 0.5f, std::sin(s * 75 + 1.5f * valueNoise(p * 7.0f, seed + 1))) *
                           glm::smoothstep(0.1f, 0.6f, up);
        const Vec3 base = glm::mix(belly_, back_, glm::smoothstep(-0.55f, 0.05f, up));
        return glm::mix(base, stripes_, 0.85f * band);
    }

    void addLeg(Mesh& mesh, std::vector<Influences>& influences, int leg) const {
        const Vec3 hip = legRoot(leg), knee = legKnee(leg), ankle = legAnkle(leg);
        const int joint = kFirstLeg + leg * kJointsPerLeg, trunk = parentOf(joint);
        const std::vector<Vec3> path = curveThrough({hip + Vec3(0, 0.05f, 0), hip - Vec3(0, 0.05f, 0), knee,
                                                     ankle + Vec3(0, 0.02f, 0), ankle - Vec3(0, 0.012f, 0)},
                                                    26);
        std::vector<float> radii;
        const float thigh = leg < 2 ? 0.058f : 0.072f;
        for (int i = 0; i < 26; ++i) {
            const float t = static_cast<float>(i) / 25;
            radii.push_back(glm::mix(thigh, 0.036f, glm::smoothstep(0.1f, 0.75f, t)) +
                            0.004f * glm::smoothstep(0.85f, 1.0f, t));
        }
        Mesh limb = tube(path, radii, 24);
        const auto weigh = [&](const Vec3& p) {
            Influences w{};
            const float upper = glm::smoothstep(hip.y + 0.06f, hip.y - 0.03f, p.y);
            const float lower = glm::smoothstep(knee.y + 0.05f, knee.y - 0.05f, p.y);
            const float foot = glm::smoothstep(ankle.y + 0.03f, ankle.y - 0.01f, p.y);
            w[static_cast<size_t>(trunk)] = 1 - upper;
            w[static_cast<size_t>(joint)] = upper * (1 - lower);
            w[static_cast<size_t>(joint + 1)] = upper * lower * (1 - foot);
            w[static_cast<size_t>(joint + 2)] = upper * lower * foot;
            return w;
        };
        for (size_t i = 0; i < limb.positions.size(); ++i)
            limb.colours.push_back(
                Vec4(glm::mix(back_, stripes_, glm::smoothstep(0.30f, 0.08f, limb.positions[i].y)), 1));
        addSkinned(mesh, influences, limb, kBack, Vec3(1), weigh);
        // A broad foot with three claws.
        Mesh foot = cushionBox({0.088f, 0.05f, 0.12f}, 0.024f, 0.004f, 3, 2);
        Mesh placedFoot;
        append(placedFoot, foot, 0, placed({ankle.x, 0.027f, ankle.z + 0.022f}));
        addSkinned(mesh, influences, placedFoot, kBack, stripes_, [&](const Vec3&) { return only(joint + 2); });
        for (const float side : {-1.0f, 0.0f, 1.0f}) {
            const Vec3 base(ankle.x + side * 0.027f, 0.02f, ankle.z + 0.074f);
            addSkinned(
                mesh, influences,
                tube({base, base + Vec3(side * 0.004f, -0.004f, 0.018f), base + Vec3(side * 0.006f, -0.012f, 0.032f)},
                     {0.011f, 0.009f, 0.003f}, 10),
                kClaws, {1, 1, 1}, [&](const Vec3&) { return only(joint + 2); });
        }
    }

    void addFace(Mesh& mesh, std::vector<Influences>& influences) const {
        const auto ball = [](float radius) {
            Profile half;
            for (int k = 0; k <= 14; ++k) {
                const float a = kPi * static_cast<float>(k) / 14;
                half.push_back({k % 14 == 0 ? 0 : radius * std::sin(a), -radius * std::cos(a)});
            }
            return lathe(half, 18);
        };
        for (const float side : {-1.0f, 1.0f}) {
            Mesh eye, pupil, nostril;
            const Vec3 at(side * 0.056f, 0.862f, 0.445f), look = glm::normalize(Vec3(side * 0.75f, 0.12f, 0.65f));
            append(eye, ball(0.027f), 0, placed(at));
            append(pupil, ball(0.0165f), 0, placed(at + look * 0.0135f));
            append(nostril, ball(0.006f), 0, placed({side * 0.017f, 0.838f, 0.573f}));
            addSkinned(mesh, influences, eye, kEyes, {1, 1, 1}, [](const Vec3&) { return only(kHead); });
            addSkinned(mesh, influences, pupil, kPupils, {1, 1, 1}, [](const Vec3&) { return only(kHead); });
            addSkinned(mesh, influences, nostril, kPupils, {1, 1, 1}, [](const Vec3&) { return only(kHead); });
        }
    }

    /// A row of rounded plates from the neck to the tail.
    void addCrest(Mesh& mesh, std::vector<Influences>& influences) const {
        const std::vector<Vec3> path = spineCurve(200);
        for (int i = 0; i < 17; ++i) {
            const float s = 0.13f + 0.74f * static_cast<float>(i) / 16;
            const auto at = static_cast<size_t>(s * 199);
            const Vec3 dir = glm::normalize(path[at + 1] - path[at]), up = glm::normalize(Vec3(0, dir.z, -dir.y));
            const float radius =
                0.020f + 0.128f * std::exp(-sqr((s - 0.49f) / 0.15f)) + 0.034f * glm::smoothstep(0.62f, 0.75f, s);
            const float size = 0.034f + 0.034f * std::exp(-sqr((s - 0.52f) / 0.22f));
            Mesh plate = cushionBox({0.016f, size * 1.7f, size * 1.25f}, 0.0075f, 0, 2, 3);
            deform(
                plate,
                [&](const Vec3& p) {
                    return Vec3(p.x, p.y,
                                p.z * (1 - 0.55f * glm::smoothstep(-0.4f * size, 0.9f * size, p.y)) -
                                    0.25f * std::max(0.0f, p.y));
                },
                60);
            Mat4 basis(1);
            basis[0] = Vec4(glm::cross(up, dir), 0), basis[1] = Vec4(up, 0), basis[2] = Vec4(dir, 0);
            basis[3] = Vec4(path[at] + up * (radius * 0.92f), 1);
            Mesh placedPlate;
            append(placedPlate, plate, 0, basis);
            addSkinned(mesh, influences, placedPlate, kBack, crest_, [s](const Vec3&) { return alongSpine(s); });
        }
    }

    float length_ = 1.4f;
    Gait gait_;
    Vec3 back_{0.10f, 0.36f, 0.34f}, belly_{0.80f, 0.70f, 0.44f}, stripes_{0.03f, 0.14f, 0.20f},
        crest_{0.80f, 0.28f, 0.06f};
    int seed_ = 1;
};

}  // namespace

std::unique_ptr<Procedural> makeCreature() { return std::make_unique<Creature>(); }

}  // namespace lumi
