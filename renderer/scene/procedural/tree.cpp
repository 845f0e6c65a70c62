#include <algorithm>

#include "scene/procedural/generators.h"

namespace lumi {
namespace {

constexpr uint32_t kLeaf = 0, kBark = 1;

/// A piece of a twig that may carry leaves.
struct TwigPiece {
    Vec3 begin{0}, end{0};
};

/// A broad-leaved tree: a trunk that forks into limbs, these into branches and twigs, and thin leaves along the twigs.
class Tree final : public Procedural {
public:
    void describe(ParameterVisitor& v) override {
        describeLength(v, "height", height_, "Height", 0.5, 40, "About that of the top leaf");
        describeLength(v, "crown", crown_, "Crown", 0.2, 30, "Width of the crown");
        describeLength(v, "trunk-radius", trunkRadius_, "Trunk radius", 0.01, 2, "At the ground");
        describeLength(v, "leaf-length", leafLength_, "Leaf length", 0.005, 1, "From stalk to tip");
        describeLength(v, "leaf-width", leafWidth_, "Leaf width", 0.002, 1, "At the widest");
        describeCount(v, "leaves", leaves_, "Leaves", 0, 200000, "Altogether");
        describeCount(v, "limbs", limbs_, "Limbs", 2, 24, "That the trunk forks into");
        v.number("bare", bare_,
                 {.label = "Bare",
                  .min = 0.05,
                  .max = 0.8,
                  .help = "Share of the height below the first limb",
                  .redo = Redo::Build});
        describeSeed(v, seed_);
    }

    ProceduralResult build() const override {
        Dice dice(seed_);
        Mesh mesh;
        std::vector<TwigPiece> twigs;
        growTrunk(mesh, dice, twigs);
        addLeaves(mesh, dice, twigs);
        return onePart(std::move(mesh), {opaqueSlot("leaf", {0.06f, 0.17f, 0.03f}, 0.45f),
                                         opaqueSlot("bark", {0.16f, 0.11f, 0.075f}, 0.9f)});
    }

private:
    /// `direction` turned by `angle` away from itself, around it by `azimuth`.
    static Vec3 turned(const Vec3& direction, float angle, float azimuth) {
        const Frame frame(direction);
        const float s = std::sin(angle);
        return frame.toWorld(Vec3(s * std::cos(azimuth), s * std::sin(azimuth), std::cos(angle)));
    }

    void growTrunk(Mesh& mesh, Dice& dice, std::vector<TwigPiece>& twigs) const {
        const float bole = height_ * bare_, top = height_ * glm::mix(bare_, 1.0f, 0.55f);
        const Vec3 lean(dice.range(-0.04f, 0.04f) * height_, 0, dice.range(-0.04f, 0.04f) * height_);
        const std::vector<Vec3> path = curveThrough({Vec3(0, -0.05f, 0), Vec3(0, 0.5f * bole, 0) + 0.3f * lean,
                                                     Vec3(0, bole, 0) + 0.5f * lean, Vec3(0, top, 0) + lean},
                                                    14);
        std::vector<float> radii;
        for (size_t i = 0; i < path.size(); ++i) {
            const float t = static_cast<float>(i) / static_cast<float>(path.size() - 1);
            radii.push_back(trunkRadius_ * (1.25f * std::exp(-9 * t) + glm::mix(0.85f, 0.3f, t)));
        }
        append(mesh, tube(path, radii, 16, false), kBark);
        for (int i = 0; i < limbs_; ++i) {
            const float t = (static_cast<float>(i) + 0.5f) / static_cast<float>(limbs_);
            const float y = glm::mix(bole, top, t);
            const Vec3 root = Vec3(0, y, 0) + lean * (0.5f + 0.5f * t);
            const float angle = glm::mix(1.15f, 0.3f, t) + dice.range(-0.12f, 0.12f);
            const Vec3 direction =
                turned(Vec3(0, 1, 0), angle, static_cast<float>(i) * 2.39996f + dice.range(-0.3f, 0.3f));
            const float reach =
                std::min(0.62f * crown_ / std::max(std::sin(angle), 0.35f), 0.75f * (height_ - y) + 0.2f * crown_);
            grow(mesh, dice, twigs, root, direction, reach * dice.range(0.85f, 1.0f),
                 trunkRadius_ * glm::mix(0.55f, 0.3f, t), 0);
        }
    }

    /// A limb (level 0), branch (1) or twig (2): a bent tube, thinner towards its end, that bears the next level.
    void grow(Mesh& mesh, Dice& dice, std::vector<TwigPiece>& twigs, const Vec3& root, const Vec3& direction,
              float length, float radius, int level) const {
        constexpr int kLevels = 3;
        const Vec3 bend = turned(direction, 0.35f, dice.range(0, 2 * kPi));
        const Vec3 tip = root + length * glm::normalize(direction + 0.5f * bend + Vec3(0, 0.25f, 0));
        const std::vector<Vec3> path = curveThrough({root, root + 0.5f * length * direction, tip}, 7);
        std::vector<float> radii;
        for (size_t i = 0; i < path.size(); ++i)
            radii.push_back(std::max(radius * (1 - 0.11f * static_cast<float>(i)), 0.0015f));
        append(mesh, tube(path, radii, level == 0 ? 9 : level == 1 ? 6 : 4, false), kBark);
        if (level > 0)
            for (size_t i = level == 1 ? 3 : 1; i + 1 < path.size(); ++i) twigs.push_back({path[i], path[i + 1]});
        if (level + 1 == kLevels) return;
        const int children = level == 0 ? 7 : 5;
        for (int i = 0; i < children; ++i) {
            const float t = glm::mix(0.28f, 1.0f, (static_cast<float>(i) + dice.unit()) / static_cast<float>(children));
            const size_t at = std::min(static_cast<size_t>(t * static_cast<float>(path.size() - 1)), path.size() - 2);
            const Vec3 along = glm::normalize(path[at + 1] - path[at]);
            const Vec3 turn = turned(along, dice.range(0.55f, 1.0f), static_cast<float>(i) * 2.39996f + dice.unit());
            grow(mesh, dice, twigs, path[at], turn, length * dice.range(0.34f, 0.5f) * (1.25f - 0.5f * t),
                 radii[at] * 0.55f, level + 1);
        }
    }

    /// Two facets on each side of the midrib, folded: thin, pointed at both ends.
    void addLeaves(Mesh& mesh, Dice& dice, const std::vector<TwigPiece>& twigs) const {
        if (twigs.empty()) return;
        for (int i = 0; i < leaves_; ++i) {
            const TwigPiece& twig = twigs[static_cast<size_t>(dice.below(static_cast<int>(twigs.size())))];
            const Vec3 root = glm::mix(twig.begin, twig.end, dice.unit());
            const Vec3 along = glm::normalize(twig.end - twig.begin);
            const Vec3 out = turned(along, dice.range(0.5f, 1.2f), dice.range(0, 2 * kPi));
            const Vec3 direction = glm::normalize(out + Vec3(0, dice.range(-0.5f, 0.1f), 0));
            const Vec3 side =
                glm::normalize(glm::cross(direction, Vec3(dice.range(-0.5f, 0.5f), 1, dice.range(-0.5f, 0.5f))));
            appendLeaf(mesh, root, direction, side, dice.range(0.7f, 1.1f));
        }
    }

    void appendLeaf(Mesh& mesh, const Vec3& root, const Vec3& direction, const Vec3& side, float size) const {
        const float length = leafLength_ * size, half = 0.5f * leafWidth_ * size;
        const Vec3 up = glm::cross(side, direction);
        const auto first = static_cast<uint32_t>(mesh.positions.size());
        const Vec3 points[] = {root, root + 0.45f * length * direction + half * side + 0.3f * half * up,
                               root + 0.5f * length * direction,
                               root + 0.45f * length * direction - half * side + 0.3f * half * up,
                               root + length * direction - 0.12f * length * up};
        const Vec2 uv[] = {{0.5f, 0}, {1, 0.45f}, {0.5f, 0.5f}, {0, 0.45f}, {0.5f, 1}};
        const float tilt[] = {0, -0.35f, 0, 0.35f, 0};
        for (int k = 0; k < 5; ++k) {
            mesh.positions.push_back(points[k]);
            mesh.normals.push_back(glm::normalize(up + tilt[k] * side));
            mesh.uv[0].push_back(uv[k]);
        }
        for (const auto& [a, b, c] : {std::array{0u, 1u, 2u}, {0u, 2u, 3u}, {1u, 4u, 2u}, {2u, 4u, 3u}}) {
            mesh.triangles.push_back({first + a, first + b, first + c});
            mesh.triangleMaterial.push_back(kLeaf);
        }
    }

    float height_ = 6, crown_ = 5, trunkRadius_ = 0.16f, leafLength_ = 0.11f, leafWidth_ = 0.045f, bare_ = 0.3f;
    int leaves_ = 12000, limbs_ = 9, seed_ = 1;
};

}  // namespace

std::unique_ptr<Procedural> makeTree() { return std::make_unique<Tree>(); }

}  // namespace lumi
