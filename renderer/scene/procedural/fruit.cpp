#include "scene/procedural/generators.h"

namespace lumi {
namespace {

constexpr uint32_t kSkin = 0, kStalk = 1;

enum class FruitKind { Apple, Pear, Lemon, Orange };

/// Contours for a diameter of 1, from the lower pole to the upper.
Profile contour(FruitKind kind) {
    switch (kind) {
        case FruitKind::Apple:
            return {{0, 0.075f},     {0.06f, 0.045f}, {0.15f, 0.012f}, {0.27f, 0.05f}, {0.40f, 0.19f},
                    {0.485f, 0.40f}, {0.495f, 0.56f}, {0.45f, 0.74f},  {0.34f, 0.86f}, {0.20f, 0.885f},
                    {0.09f, 0.845f}, {0.03f, 0.79f},  {0, 0.765f}};
        case FruitKind::Pear:
            return {{0, 0.06f},      {0.05f, 0.035f}, {0.14f, 0.01f},  {0.30f, 0.07f}, {0.44f, 0.22f},
                    {0.495f, 0.42f}, {0.47f, 0.60f},  {0.37f, 0.79f},  {0.25f, 0.97f}, {0.185f, 1.12f},
                    {0.15f, 1.24f},  {0.09f, 1.31f},  {0.03f, 1.315f}, {0, 1.30f}};
        case FruitKind::Lemon:
            return {{0, -0.03f},    {0.06f, 0},      {0.10f, 0.05f}, {0.20f, 0.12f}, {0.36f, 0.27f},
                    {0.47f, 0.48f}, {0.495f, 0.65f}, {0.45f, 0.86f}, {0.33f, 1.05f}, {0.18f, 1.18f},
                    {0.09f, 1.25f}, {0.07f, 1.31f},  {0, 1.34f}};
        case FruitKind::Orange:
            return {{0, 0.045f},     {0.06f, 0.03f},  {0.15f, 0.018f}, {0.33f, 0.11f},  {0.46f, 0.28f}, {0.5f, 0.47f},
                    {0.465f, 0.68f}, {0.345f, 0.84f}, {0.17f, 0.93f},  {0.06f, 0.935f}, {0, 0.925f}};
    }
    return {};
}

/// A fruit standing on its lower end, with its stalk. uv: u around, v up, both from 0 to 1.
class Fruit final : public Procedural {
public:
    void describe(ParameterVisitor& v) override {
        v.choice("kind", kind_,
                 {.label = "Kind",
                  .options = {"apple", "pear", "lemon", "orange"},
                  .help = "Which fruit",
                  .redo = Redo::Build});
        describeLength(v, "diameter", diameter_, "Diameter", 0.005, 1, "At the widest");
        describeSeed(v, seed_);
    }

    ProceduralResult build() const override {
        const auto seed = static_cast<uint32_t>(seed_);
        Profile profile = contour(kind_);
        float top = 0;
        for (ProfilePoint& p : profile) top = std::max(top, p.height);
        Mesh skin = lathe(smoothProfile(profile, 4), 72);
        for (size_t i = 0; i < skin.positions.size(); ++i) {
            const Vec3 p = skin.positions[i];
            skin.uv[0][i] = {skin.uv[0][i].x / kPi, p.y / top};
        }
        const bool citrus = kind_ == FruitKind::Lemon || kind_ == FruitKind::Orange;
        const float lobes = kind_ == FruitKind::Apple ? 0.028f : 0.0f;
        deform(
            skin,
            [&](const Vec3& p) {
                const float angle = std::atan2(p.z, p.x);
                const float lump = 1 + lobes * (0.6f - p.y) * std::cos(5 * angle) + 0.045f * valueNoise(p * 2.2f, seed);
                const float pores = citrus ? 1 - 0.007f * std::max(0.0f, valueNoise(p * 26.0f, seed + 1)) : 1;
                const float bow = kind_ == FruitKind::Pear ? 0.09f * sqr(std::max(0.0f, p.y - 0.4f)) : 0;
                return Vec3(p.x * lump * pores + bow, p.y * (1 + 0.03f * valueNoise(p * 1.7f, seed + 2)),
                            p.z * lump * pores) *
                       diameter_;
            },
            80);
        tint(skin, seed);
        Mesh mesh;
        append(mesh, skin, kSkin);
        if (!citrus) addStalk(mesh);
        const bool apple = kind_ == FruitKind::Apple;
        return onePart(std::move(mesh), {opaqueSlot("skin", {1, 1, 1},
                                                    apple    ? 0.22f
                                                    : citrus ? 0.38f
                                                             : 0.42f),
                                         opaqueSlot("stalk", {0.10f, 0.06f, 0.03f}, 0.8f)});
    }

private:
    /// Ripe and unripe sides, streaks from pole to pole, freckles.
    void tint(Mesh& skin, uint32_t seed) const {
        skin.colours.resize(skin.positions.size());
        for (size_t i = 0; i < skin.positions.size(); ++i) {
            const Vec3 p = skin.positions[i] / diameter_;
            const float angle = std::atan2(p.z, p.x);
            const float side = 0.5f + 0.5f * std::cos(angle - 0.7f) + 0.35f * valueNoise(p * 2.5f, seed + 4);
            const float streak = valueNoise(Vec3(std::cos(angle) * 9, p.y * 1.2f, std::sin(angle) * 9), seed + 5);
            const float freckle = std::max(0.0f, valueNoise(p * 30.0f, seed + 6) - 0.55f);
            Vec3 c;
            switch (kind_) {
                case FruitKind::Apple:
                    c = glm::mix(Vec3(0.50f, 0.42f, 0.06f), Vec3(0.44f, 0.018f, 0.016f),
                                 glm::smoothstep(0.05f, 0.75f, side + 0.25f * streak));
                    break;
                case FruitKind::Pear:
                    c = glm::mix(Vec3(0.46f, 0.44f, 0.08f), Vec3(0.52f, 0.24f, 0.05f),
                                 0.6f * glm::smoothstep(0.5f, 1.2f, side)) *
                        (1 - 0.9f * freckle);
                    break;
                case FruitKind::Lemon:
                    c = glm::mix(Vec3(0.82f, 0.58f, 0.03f), Vec3(0.62f, 0.56f, 0.04f), 0.4f * side);
                    break;
                case FruitKind::Orange:
                    c = glm::mix(Vec3(0.82f, 0.26f, 0.012f), Vec3(0.80f, 0.34f, 0.02f), 0.5f * side);
                    break;
            }
            skin.colours[i] = Vec4(c, 1);
        }
    }

    void addStalk(Mesh& mesh) const {
        const float d = diameter_, y = kind_ == FruitKind::Apple ? 0.75f * d : 1.28f * d;
        const float bow = kind_ == FruitKind::Pear ? 0.07f * d : 0;
        const std::vector<Vec3> path = curveThrough({Vec3(bow, y, 0), Vec3(bow + 0.01f * d, y + 0.12f * d, 0.01f * d),
                                                     Vec3(bow + 0.07f * d, y + 0.25f * d, 0.03f * d)},
                                                    9);
        std::vector<float> radii(path.size(), 0.017f * d);
        radii.back() = 0.026f * d;
        append(mesh, tube(path, radii, 10), kStalk);
    }

    FruitKind kind_ = FruitKind::Apple;
    float diameter_ = 0.08f;
    int seed_ = 1;
};

/// A bunch of grapes that lies on y = 0 along X: berries of one mesh, instanced, around a branching stalk.
class Grapes final : public Procedural {
public:
    void describe(ParameterVisitor& v) override {
        describeCount(v, "berries", berries_, "Berries", 1, 300, "In the bunch");
        describeLength(v, "berry-diameter", diameter_, "Berry diameter", 0.002, 0.1, "Across a berry");
        describeSeed(v, seed_);
    }

    ProceduralResult build() const override {
        ProceduralResult result;
        result.slots = {opaqueSlot("skin", {0.085f, 0.018f, 0.055f}, 0.25f),
                        opaqueSlot("stalk", {0.16f, 0.13f, 0.05f}, 0.8f)};
        Profile round;
        for (int k = 0; k <= 14; ++k) {
            const float a = kPi * static_cast<float>(k) / 14;
            round.push_back({k % 14 == 0 ? 0 : 0.5f * diameter_ * std::sin(a), -0.55f * diameter_ * std::cos(a)});
        }
        Mesh sphere = lathe(round, 24);
        tidy(sphere);
        const auto berry = std::make_shared<const Mesh>(std::move(sphere));
        std::vector<Vec3> centres;
        settle(centres);
        Dice dice(seed_ + 17);
        for (size_t i = 0; i < centres.size(); ++i) {
            Node node;
            node.local.translation = centres[i];
            node.local.rotation =
                glm::normalize(Quat(dice.range(-1, 1), dice.range(-1, 1), dice.range(-1, 1), dice.range(-1, 1)));
            node.local.scale = Vec3(dice.range(0.9f, 1.06f));
            result.nodes.push_back(node);
            ProceduralPart part;
            part.name = "berry-" + std::to_string(i + 1);
            part.mesh = berry;
            part.node = static_cast<int>(i);
            result.parts.push_back(std::move(part));
        }
        addStalk(result);
        return result;
    }

private:
    float length() const { return diameter_ * 0.62f * std::cbrt(static_cast<float>(berries_)) * 2.2f; }

    /// Berries drop one by one into a tapering heap, each as low as those before it allow.
    void settle(std::vector<Vec3>& centres) const {
        Dice dice(seed_);
        const float d = diameter_, span = length();
        for (int i = 0; i < berries_; ++i) {
            Vec3 best(0, 1e9f, 0);
            for (int attempt = 0; attempt < 24; ++attempt) {
                const float t = dice.unit(),
                            taper = 0.30f + 0.70f * std::sin(kPi * std::pow(1 - t, 0.8f) * 0.85f + 0.15f);
                const float z = (dice.unit() + dice.unit() - 1) * span * 0.42f * taper;
                const Vec3 low((t - 0.5f) * span, 0.5f * d, z);
                float y = low.y;
                for (const Vec3& other : centres) {
                    const float flat2 = sqr(other.x - low.x) + sqr(other.z - low.z), reach = d * 0.95f;
                    if (flat2 < reach * reach) y = std::max(y, other.y + std::sqrt(reach * reach - flat2));
                }
                if (y < best.y) best = Vec3(low.x, y, low.z);
            }
            centres.push_back(best);
        }
    }

    void addStalk(ProceduralResult& result) const {
        const float d = diameter_, span = length();
        const std::vector<Vec3> path =
            curveThrough({Vec3(0, 1.6f * d, 0), Vec3(-0.3f * span, 2.1f * d, 0.1f * d),
                          Vec3(-0.55f * span, 1.7f * d, 0.2f * d), Vec3(-0.74f * span, 1.9f * d, 0.7f * d)},
                         17);
        Mesh stalk;
        append(stalk, tube(path, std::vector<float>(path.size(), 0.09f * d), 10));
        append(stalk,
               tube({path.back() + Vec3(0.1f * d, 0, 0.8f * d), path.back(), path.back() - Vec3(0.1f * d, 0, 0.7f * d)},
                    {0.07f * d, 0.12f * d, 0.07f * d}, 10));
        for (uint32_t& slot : stalk.triangleMaterial) slot = kStalk;
        addPart(result, "stalk", std::move(stalk));
    }

    int berries_ = 60, seed_ = 1;
    float diameter_ = 0.021f;
};

}  // namespace

std::unique_ptr<Procedural> makeFruit() { return std::make_unique<Fruit>(); }
std::unique_ptr<Procedural> makeGrapes() { return std::make_unique<Grapes>(); }

}  // namespace lumi
