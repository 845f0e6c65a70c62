#include "scene/procedural/generators.h"

namespace lumi {
namespace {

constexpr uint32_t kLeaf = 0, kStem = 1, kPot = 2, kSoil = 3;

/// One leaf along +Z from the origin, its upper face +Y: a pointed oval that arches down, folded along its midrib,
/// with a gentle wave at the margin.
Mesh leaf(float length, float width, float arch, float wave, int seed) {
    return gridSurface(
        6, 12,
        [&](float u, float v) {
            const float across = 2 * u - 1;
            // Widest at a third of its length, pointed at the tip.
            const float half = width * 0.5f * std::pow(std::max(std::sin(kPi * std::pow(v, 0.72f)), 0.0f), 0.85f);
            const float bend = arch * v * v;
            const float fold = 0.22f * half * (1 - std::abs(across));
            const float ripple = wave * half * across * across *
                                 std::sin(v * 21 + static_cast<float>(seed) + (across > 0 ? 0.0f : 1.7f));
            const float z = length * (bend > 1e-3f ? std::sin(bend) / arch : v);
            const float y = -length * (bend > 1e-3f ? (1 - std::cos(bend)) / arch : 0) - fold + ripple;
            return Vec3(-across * half, y, z);
        },
        Vec2(1));
}

/// A potted plant: stems from the soil, each with an arching leaf; younger ones steeper and nearer the middle.
class Plant final : public Procedural {
public:
    void describe(ParameterVisitor& v) override {
        describeLength(v, "height", height_, "Height", 0.1, 5, "Of the longest stem over the soil");
        describeLength(v, "leaf-length", leafLength_, "Leaf length", 0.03, 1.5, "From stalk to tip");
        describeLength(v, "leaf-width", leafWidth_, "Leaf width", 0.01, 1, "At the widest");
        describeCount(v, "leaves", leaves_, "Leaves", 1, 400, "Altogether");
        describeLength(v, "pot-radius", potRadius_, "Pot radius", 0.03, 1, "At the rim");
        describeLength(v, "pot-height", potHeight_, "Pot height", 0.03, 1, "Over the ground");
        v.number(
            "spread", spread_,
            {.label = "Spread", .min = 0, .max = 1, .help = "How far the stems lean outwards", .redo = Redo::Build});
        describeSeed(v, seed_);
    }

    ProceduralResult build() const override {
        Dice dice(seed_);
        Mesh mesh;
        addPot(mesh, dice);
        const float soil = potHeight_ * 0.9f;
        for (int i = 0; i < leaves_; ++i) {
            const float age = (static_cast<float>(i) + 0.5f) / static_cast<float>(leaves_);
            const float azimuth = static_cast<float>(i) * 2.39996f + dice.range(-0.3f, 0.3f);
            addLeaf(mesh, dice, soil, age, azimuth);
        }
        return onePart(
            std::move(mesh),
            {opaqueSlot("leaf", {0.07f, 0.20f, 0.045f}, 0.35f), opaqueSlot("stem", {0.16f, 0.24f, 0.07f}, 0.6f),
             opaqueSlot("pot", {0.50f, 0.24f, 0.14f}, 0.7f), opaqueSlot("soil", {0.045f, 0.03f, 0.02f}, 0.95f)});
    }

private:
    void addPot(Mesh& mesh, Dice& dice) const {
        const float r = potRadius_, h = potHeight_, t = r * 0.07f;
        append(mesh,
               lathe(smoothProfile({{0, 0},
                                    {r * 0.66f, 0, true},
                                    {r * 0.70f, h * 0.03f},
                                    {r * 0.86f, h * 0.55f},
                                    {r * 0.94f, h * 0.84f, true},
                                    {r, h * 0.845f, true},
                                    {r * 1.02f, h * 0.97f},
                                    {r, h},
                                    {r - t * 0.5f, h},
                                    {r - t, h * 0.97f},
                                    {r * 0.82f, h * 0.8f, true},
                                    {0, h * 0.8f}},
                                   2),
                     32),
               kPot);
        const auto salt = static_cast<uint32_t>(dice.below(1000));
        append(mesh,
               gridSurface(
                   24, 5,
                   [&](float u, float v) {
                       const float a = -2 * kPi * u, q = r * 0.93f * v;
                       const Vec3 p(q * std::cos(a), 0, q * std::sin(a));
                       return p + Vec3(0,
                                       h * 0.9f + 0.05f * r * valueNoise(p * (9 / r), salt) + 0.06f * r * (1 - v * v),
                                       0);
                   },
                   Vec2(1), true),
               kSoil);
    }

    void addLeaf(Mesh& mesh, Dice& dice, float soil, float age, float azimuth) const {
        const float tall = height_ * glm::mix(1.0f, 0.42f, age) * dice.range(0.85f, 1.05f);
        const float lean = spread_ * glm::mix(0.16f, 1.0f, std::pow(age, 0.8f)) * dice.range(0.8f, 1.2f);
        const Vec3 outward(std::sin(azimuth), 0, std::cos(azimuth));
        const Vec3 root = outward * (potRadius_ * 0.35f * age) + Vec3(0, soil - 0.01f, 0);
        const Vec3 top = root + outward * (tall * lean * 0.75f) + Vec3(0, tall, 0);
        const Vec3 middle = glm::mix(root, top, 0.5f) - outward * (tall * lean * 0.16f);
        const std::vector<Vec3> path = curveThrough({root, middle, top}, 7);
        const float thick = 0.0035f + 0.006f * height_;
        std::vector<float> radii;
        for (int k = 0; k < 7; ++k) radii.push_back(thick * (1 - 0.08f * static_cast<float>(k)));
        append(mesh, tube(path, radii, 5, false), kStem);

        const float size = dice.range(0.75f, 1.1f) * glm::mix(0.8f, 1.0f, age);
        const float pitch = glm::mix(-58.0f, -6.0f, std::pow(age, 0.7f)) + dice.range(-8, 8);
        const Mesh blade =
            leaf(leafLength_ * size, leafWidth_ * size, dice.range(0.75f, 1.25f), 0.09f, seed_ + dice.below(50));
        append(mesh, blade, kLeaf,
               placed(top) * placed({0, 0, 0}, {0, degrees(azimuth) + dice.range(-14, 14), 0}) *
                   placed({0, 0, 0}, {pitch, 0, dice.range(-12, 12)}));
    }

    float height_ = 0.75f, leafLength_ = 0.38f, leafWidth_ = 0.19f, potRadius_ = 0.17f, potHeight_ = 0.30f,
          spread_ = 0.5f;
    int leaves_ = 22, seed_ = 1;
};

}  // namespace

std::unique_ptr<Procedural> makePlant() { return std::make_unique<Plant>(); }

}  // namespace lumi
