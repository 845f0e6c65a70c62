#include <algorithm>

#include "scene/procedural/generators.h"
#include "scene/procedural/implicit_surface.h"

namespace lumi {
namespace {

constexpr uint32_t kSkin = 0, kBone = 1, kEyes = 2, kPupils = 3;

/// Joints, parents first; what hangs on both sides left (+X), then right.
enum Joint { kPelvis, kChest, kHead, kArmLeft, kForearmLeft, kArmRight, kForearmRight, kJoints };
constexpr std::array<int, kJoints> kParents{-1, kPelvis, kChest, kChest, kArmLeft, kChest, kArmRight};
const std::array<Vec3, kJoints> kRest{Vec3(0, 0.34f, 0),          Vec3(0, 0.56f, -0.02f),     Vec3(0, 0.83f, 0.05f),
                                      Vec3(0.25f, 0.72f, 0),      Vec3(0.365f, 0.52f, 0.02f), Vec3(-0.25f, 0.72f, 0),
                                      Vec3(-0.365f, 0.52f, 0.02f)};
constexpr std::array<const char*, kJoints> kNames{"pelvis",       "chest",     "head",         "arm-left",
                                                  "forearm-left", "arm-right", "forearm-right"};
using Influences = std::array<float, kJoints>;

/// The trunk, limbs and head of a figure 1.02 high to the crown that stands on y = 0 and looks along +Z.
SoftBody bodyShape() {
    SoftBody body;
    body.addEllipsoid({0, 0.62f, 0}, {0.235f, 0.22f, 0.175f}, 0);
    body.addEllipsoid({0, 0.46f, 0.055f}, {0.25f, 0.20f, 0.225f}, 0.07f);
    body.addEllipsoid({0, 0.33f, -0.01f}, {0.19f, 0.12f, 0.16f}, 0.07f);
    body.addEllipsoid({0, 0.73f, -0.075f}, {0.21f, 0.13f, 0.14f}, 0.06f);
    body.addCone({0, 0.76f, 0.03f}, {0, 0.86f, 0.11f}, 0.115f, 0.10f, 0.05f);
    body.addEllipsoid({0, 0.89f, 0.135f}, {0.112f, 0.125f, 0.120f}, 0.03f);
    body.addEllipsoid({0, 0.805f, 0.19f}, {0.108f, 0.062f, 0.088f}, 0.03f);
    for (const float side : {1.0f, -1.0f}) {
        const auto at = [side](float x, float y, float z) { return Vec3(side * x, y, z); };
        body.addEllipsoid(at(0.105f, 0.645f, 0.125f), {0.10f, 0.068f, 0.055f}, 0.035f);  // chest
        body.addCone(at(0.12f, 0.79f, -0.02f), at(0.25f, 0.735f, 0), 0.075f, 0.105f, 0.05f);
        body.addCone(at(0.255f, 0.72f, 0), at(0.365f, 0.52f, 0.02f), 0.088f, 0.062f, 0.04f);
        body.addEllipsoid(at(0.315f, 0.63f, 0.025f), {0.066f, 0.085f, 0.066f}, 0.03f);  // upper arm
        body.addCone(at(0.365f, 0.52f, 0.02f), at(0.36f, 0.33f, 0.13f), 0.068f, 0.050f, 0.03f);
        body.addEllipsoid(at(0.375f, 0.455f, 0.065f), {0.064f, 0.075f, 0.064f}, 0.03f);  // forearm
        body.addEllipsoid(at(0.355f, 0.275f, 0.165f), {0.052f, 0.062f, 0.052f}, 0.03f);
        for (int finger = 0; finger < 4; ++finger) {
            const float x = 0.322f + 0.023f * static_cast<float>(finger);
            body.addCone(at(x, 0.240f, 0.195f), at(x - 0.006f, 0.195f, 0.200f), 0.019f, 0.015f, 0.010f);
            body.addCone(at(x - 0.006f, 0.195f, 0.200f), at(x - 0.010f, 0.172f, 0.178f), 0.015f, 0.012f, 0.008f);
        }
        body.addCone(at(0.315f, 0.275f, 0.19f), at(0.296f, 0.228f, 0.215f), 0.021f, 0.015f, 0.012f);
        body.addCone(at(0.125f, 0.31f, 0), at(0.155f, 0.18f, 0.035f), 0.108f, 0.080f, 0.05f);
        body.addCone(at(0.155f, 0.18f, 0.035f), at(0.155f, 0.06f, 0), 0.072f, 0.062f, 0.03f);
        body.addEllipsoid(at(0.158f, 0.15f, -0.012f), {0.062f, 0.07f, 0.062f}, 0.03f);
        body.addEllipsoid(at(0.162f, 0.036f, 0.055f), {0.070f, 0.040f, 0.100f}, 0.03f);
        for (int toe = 0; toe < 3; ++toe)
            body.addEllipsoid(
                at(0.120f + 0.042f * static_cast<float>(toe), 0.026f, 0.140f - 0.008f * static_cast<float>(toe * toe)),
                {0.024f, 0.026f, 0.032f}, 0.012f);
        // The face: brow, cheek, ear, nostril, socket.
        body.addCone(at(0.012f, 0.926f, 0.248f), at(0.082f, 0.932f, 0.215f), 0.024f, 0.022f, 0.020f);
        body.addEllipsoid(at(0.070f, 0.858f, 0.225f), {0.038f, 0.030f, 0.034f}, 0.022f);
        body.addCone(at(0.105f, 0.895f, 0.125f), at(0.205f, 0.955f, 0.070f), 0.030f, 0.009f, 0.020f);
        body.carveCone(at(0.130f, 0.912f, 0.135f), at(0.185f, 0.945f, 0.098f), 0.016f, 0.005f, 0.012f);
        body.carveCone(at(0.047f, 0.892f, 0.262f), at(0.047f, 0.892f, 0.262f), 0.030f, 0.030f, 0.014f);
        body.addEllipsoid(at(0.026f, 0.857f, 0.272f), {0.022f, 0.018f, 0.022f}, 0.014f);
    }
    body.addCone({0, 0.905f, 0.252f}, {0, 0.862f, 0.292f}, 0.020f, 0.030f, 0.016f);
    body.carveCone({-0.062f, 0.818f, 0.262f}, {0.062f, 0.818f, 0.262f}, 0.009f, 0.009f, 0.010f);
    body.addCone({-0.050f, 0.796f, 0.268f}, {0.050f, 0.796f, 0.268f}, 0.017f, 0.017f, 0.014f);
    body.carveCone({0, 0.455f, 0.288f}, {0, 0.455f, 0.288f}, 0.016f, 0.016f, 0.02f);
    return body;
}

/// How much of `p` follows each joint.
Influences influencesAt(const Vec3& p) {
    Influences w{};
    const float side = p.x >= 0 ? 1.0f : -1.0f, x = std::abs(p.x);
    const float chest = glm::smoothstep(0.38f, 0.62f, p.y),
                head = glm::smoothstep(0.75f, 0.84f, p.y + 0.25f * p.z - 0.5f * std::max(0.0f, x - 0.1f));
    // Across the shoulder, then down the arm; hands hang beside the thighs, a finger's width away.
    const float raised = glm::smoothstep(0.52f, 0.68f, p.y), inner = glm::mix(0.252f, 0.17f, raised),
                outer = glm::mix(0.274f, 0.255f, raised);
    const float arm = glm::smoothstep(0.19f, 0.30f, x + 0.35f * (0.70f - p.y)) * glm::smoothstep(inner, outer, x);
    const float forearm = glm::smoothstep(0.57f, 0.47f, p.y) * arm;
    const int first = side > 0 ? kArmLeft : kArmRight;
    w[kPelvis] = (1 - arm) * (1 - chest);
    w[kChest] = (1 - arm) * chest * (1 - head);
    w[kHead] = (1 - arm) * chest * head;
    w[static_cast<size_t>(first)] = arm - forearm;
    w[static_cast<size_t>(first + 1)] = forearm;
    return w;
}

/// A stout figure with tusks and horns, all of it round: a skinned mesh over seven joints that breathes (a morph
/// target), looks about and flexes its arms in one loop.
class Ogre final : public Procedural {
public:
    void describe(ParameterVisitor& v) override {
        describeLength(v, "height", height_, "Height", 0.05, 20, "From the soles to the crown, without the horns");
        v.number(
            "period", period_,
            {.label = "Period", .min = 0.1, .max = 60, .unit = "s", .help = "Time of one loop", .redo = Redo::Build});
        v.number("cell", cell_,
                 {.label = "Cell",
                  .min = 0.004,
                  .max = 0.05,
                  .scale = Scale::Log,
                  .help = "Side of the triangles as a share of the height",
                  .redo = Redo::Build});
        v.number("bumps", bumps_,
                 {.label = "Bumps",
                  .min = 0,
                  .max = 2,
                  .help = "Height of the skin's relief as a multiple of the design's",
                  .redo = Redo::Build});
        v.colour("back", back_, {.label = "Back", .help = "Colour of the upper side", .redo = Redo::Build});
        v.colour("belly", belly_, {.label = "Belly", .help = "Colour of the underside", .redo = Redo::Build});
        describeSeed(v, seed_);
    }

    ProceduralResult build() const override {
        ProceduralResult result;
        result.slots = {opaqueSlot("skin", {1, 1, 1}, 0.18f), opaqueSlot("bone", {0.82f, 0.74f, 0.58f}, 0.2f),
                        opaqueSlot("eyes", {0.85f, 0.70f, 0.25f}, 0.08f),
                        opaqueSlot("pupils", {0.01f, 0.01f, 0.01f}, 0.05f)};
        Mesh mesh = skin();
        const size_t skinCount = mesh.positions.size();
        addFace(mesh);
        std::vector<Influences> influences;
        for (size_t i = 0; i < mesh.positions.size(); ++i)
            influences.push_back(i < skinCount ? influencesAt(mesh.positions[i]) : only(kHead));
        addBreath(mesh);
        for (Vec3& p : mesh.positions) p *= scale();
        for (Vec3& p : mesh.morphTargets[0].positions) p *= scale();
        for (const Influences& w : influences) addInfluences(mesh.skin, w);
        addSkeleton(result);
        addLoop(result);
        ProceduralPart part;
        part.mesh = std::make_shared<const Mesh>(std::move(mesh));
        part.node = 0;
        part.skin = 0;
        result.parts.push_back(std::move(part));
        return result;
    }

private:
    float scale() const { return height_ / 1.02f; }
    static Influences only(int joint) {
        Influences w{};
        w[static_cast<size_t>(joint)] = 1;
        return w;
    }

    Mesh skin() const {
        const SoftBody body = bodyShape();
        const auto seed = static_cast<uint32_t>(seed_);
        const auto field = [&](const Vec3& p) {
            const float d = body.distance(p);
            if (std::abs(d) > 0.03f || bumps_ == 0) return d;
            // Warts and folds on the back and the shoulders, little on the face.
            const float rough = glm::smoothstep(0.10f, -0.10f, p.z) * glm::smoothstep(0.30f, 0.60f, p.y);
            const float warts = std::pow(std::max(0.0f, valueNoise(p * 26.0f, seed)), 2.0f);
            return d - bumps_ * (0.011f * rough * warts + 0.0016f * valueNoise(p * 34.0f, seed + 1));
        };
        Mesh mesh = surfaceOf(field, {{-0.48f, -0.03f, -0.28f}, {0.48f, 1.06f, 0.36f}}, cell_);
        for (size_t i = 0; i < mesh.positions.size(); ++i) {
            const Vec3 p = mesh.positions[i];
            const float up =
                -0.7f * mesh.normals[i].z + 0.5f * mesh.normals[i].y + 0.3f * valueNoise(p * 8.0f, seed + 2);
            const float spots =
                glm::smoothstep(0.35f, 0.55f, valueNoise(p * 15.0f, seed + 3)) * glm::smoothstep(-0.2f, 0.4f, up);
            mesh.colours.push_back(Vec4(
                glm::mix(glm::mix(belly_, back_, glm::smoothstep(-0.6f, 0.25f, up)), back_ * 0.45f, 0.7f * spots), 1));
        }
        mesh.triangleMaterial.assign(mesh.triangles.size(), kSkin);
        return mesh;
    }

    static void addFace(Mesh& mesh) {
        const auto ball = [&](const Vec3& at, float radius, uint32_t slot) {
            Mesh part = roundedBox(Vec3(2 * radius), radius, 8);
            paint(part, Vec3(1));
            append(mesh, part, slot, placed(at));
        };
        const auto horn = [&](const std::vector<Vec3>& way, const std::vector<float>& radii) {
            std::vector<Vec3> fine;
            for (const float r : radii) fine.push_back(Vec3(r));
            const std::vector<Vec3> path = curveThrough(way, 24), widths = curveThrough(fine, 24);
            std::vector<float> thick;
            for (const Vec3& r : widths) thick.push_back(std::max(r.x, 0.001f));
            Mesh part = tube(path, thick, 20);
            paint(part, Vec3(1));
            append(mesh, part, kBone);
        };
        for (const float side : {1.0f, -1.0f}) {
            const auto at = [side](float x, float y, float z) { return Vec3(side * x, y, z); };
            const Vec3 eye = at(0.047f, 0.891f, 0.240f);
            ball(eye, 0.026f, kEyes);
            ball(eye + at(-0.002f, -0.002f, 0.0145f), 0.0128f, kPupils);
            horn({at(0.056f, 0.795f, 0.262f), at(0.062f, 0.830f, 0.290f), at(0.074f, 0.872f, 0.298f)},
                 {0.014f, 0.012f, 0.002f});
            horn({at(0.060f, 0.985f, 0.130f), at(0.115f, 1.040f, 0.115f), at(0.135f, 1.105f, 0.150f),
                  at(0.110f, 1.150f, 0.195f)},
                 {0.030f, 0.025f, 0.016f, 0.002f});
        }
    }

    /// The belly and the chest swell; normals follow the swollen shape.
    static void addBreath(Mesh& mesh) {
        MorphTarget breath;
        Mesh swollen = mesh;
        for (size_t i = 0; i < mesh.positions.size(); ++i) {
            const Vec3 p = mesh.positions[i];
            const float belly = std::exp(-glm::dot(p - Vec3(0, 0.45f, 0.16f), p - Vec3(0, 0.45f, 0.16f)) / sqr(0.16f));
            const float chest = std::exp(-glm::dot(p - Vec3(0, 0.66f, 0.06f), p - Vec3(0, 0.66f, 0.06f)) / sqr(0.13f));
            breath.positions.push_back(mesh.normals[i] * (0.030f * belly + 0.014f * chest));
            swollen.positions[i] += breath.positions.back();
        }
        Mesh rest = mesh;
        computeNormals(rest);
        computeNormals(swollen);
        for (size_t i = 0; i < mesh.positions.size(); ++i)
            breath.normals.push_back(swollen.normals[i] - rest.normals[i]);
        mesh.morphTargets.push_back(std::move(breath));
    }

    void addSkeleton(ProceduralResult& result) const {
        Skin skin;
        for (int joint = 0; joint < kJoints; ++joint) {
            const auto j = static_cast<size_t>(joint);
            Node node;
            node.name = kNames[j];
            node.parent = kParents[j];
            node.local.translation =
                (kRest[j] - (node.parent < 0 ? Vec3(0) : kRest[static_cast<size_t>(node.parent)])) * scale();
            if (joint == kPelvis) node.morphWeights = {0};
            result.nodes.push_back(std::move(node));
            skin.joints.push_back(joint);
            skin.inverseBind.push_back(Transform{-kRest[j] * scale(), {1, 0, 0, 0}, Vec3(1)}.matrix());
        }
        result.skins.push_back(std::move(skin));
    }

    /// Every joint swings in sines of the loop; keys are dense enough for linear interpolation.
    void addLoop(ProceduralResult& result) const {
        constexpr int kKeys = 48;
        Animation loop;
        loop.duration = period_;
        const auto channel = [&](int node, AnimatedProperty property, int components,
                                 const std::function<std::vector<float>(float)>& at) {
            AnimationChannel made;
            made.node = node, made.property = property, made.components = components;
            for (int k = 0; k <= kKeys; ++k) {
                const std::vector<float> values = at(2 * kPi * static_cast<float>(k % kKeys) / kKeys);
                made.times.push_back(period_ * static_cast<float>(k) / kKeys);
                made.values.insert(made.values.end(), values.begin(), values.end());
            }
            loop.channels.push_back(std::move(made));
        };
        const auto turn = [&](int joint, const std::function<Vec3(float)>& eulerDeg) {
            channel(joint, AnimatedProperty::Rotation, 4, [&](float w) {
                const Vec3 e = eulerDeg(w);
                const Quat q = glm::angleAxis(radians(e.y), Vec3(0, 1, 0)) *
                               glm::angleAxis(radians(e.x), Vec3(1, 0, 0)) *
                               glm::angleAxis(radians(e.z), Vec3(0, 0, 1));
                return std::vector<float>{q.x, q.y, q.z, q.w};
            });
        };
        channel(kPelvis, AnimatedProperty::MorphWeights, 1,
                [](float w) { return std::vector<float>{0.5f + 0.5f * std::sin(2 * w)}; });
        turn(kChest, [](float w) { return Vec3(2.5f * std::sin(2 * w), 9 * std::sin(w), 3 * std::cos(w)); });
        turn(kHead, [](float w) { return Vec3(7 * std::sin(2 * w + 1), 24 * std::sin(w - 0.5f), -6 * std::sin(w)); });
        turn(kArmLeft, [](float w) { return Vec3(-14 * std::sin(w), 0, 7 + 6 * std::cos(w)); });
        turn(kForearmLeft, [](float w) { return Vec3(-28 - 26 * std::sin(w + 0.4f), 0, 0); });
        turn(kArmRight, [](float w) { return Vec3(13 * std::sin(w), 0, -7 + 6 * std::cos(w)); });
        turn(kForearmRight, [](float w) { return Vec3(-28 + 26 * std::sin(w + 0.4f), 0, 0); });
        result.animations.push_back(std::move(loop));
    }

    float height_ = 1.6f, period_ = 4, cell_ = 0.0095f, bumps_ = 1;
    Vec3 back_{0.09f, 0.26f, 0.13f}, belly_{0.38f, 0.46f, 0.20f};
    int seed_ = 1;
};

}  // namespace

std::unique_ptr<Procedural> makeOgre() { return std::make_unique<Ogre>(); }

}  // namespace lumi
