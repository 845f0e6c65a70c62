#include "scene/procedural/generators.h"

namespace lumi {
namespace {

constexpr int kTargets = 3;

/// A ball that morphs between three lobed forms, centred on the origin; one looping animation of the weights.
class Blob final : public Procedural {
public:
    void describe(ParameterVisitor& v) override {
        describeLength(v, "radius", radius_, "Radius", 0.01, 20, "Of the ball at rest");
        v.number("swing", swing_,
                 {.label = "Swing", .min = 0, .max = 0.6, .help = "Height of the lobes in radii", .redo = Redo::Build});
        v.number("period", period_,
                 {.label = "Period",
                  .min = 0.1,
                  .max = 60,
                  .unit = "s",
                  .help = "Time after which the forms return",
                  .redo = Redo::Build});
        describeCount(v, "segments", segments_, "Segments", 12, 400, "Facets around");
    }

    ProceduralResult build() const override {
        Mesh mesh = ball(-1);
        for (int target = 0; target < kTargets; ++target) {
            const Mesh moved = ball(target);
            MorphTarget morph;
            for (size_t i = 0; i < mesh.positions.size(); ++i) {
                morph.positions.push_back(moved.positions[i] - mesh.positions[i]);
                morph.normals.push_back(moved.normals[i] - mesh.normals[i]);
            }
            mesh.morphTargets.push_back(std::move(morph));
        }
        ProceduralResult result;
        result.slots = {opaqueSlot("surface", {0.95f, 0.75f, 0.40f}, 0.12f, 1)};
        Node node;
        node.name = "blob";
        node.morphWeights.assign(kTargets, 0);
        result.nodes.push_back(std::move(node));
        ProceduralPart part;
        part.mesh = std::make_shared<const Mesh>(std::move(mesh));
        part.node = 0;
        result.parts.push_back(std::move(part));
        result.animations.push_back(breathing());
        return result;
    }

private:
    /// Height over the ball, in units of `swing`, of a form in direction d.
    static float lobes(int target, const Vec3& d) {
        switch (target) {
            case 0: return 1.6f * (d.x * d.x - d.z * d.z) * (1 - d.y * d.y) + 0.8f * (3 * d.y * d.y - 1) * 0.5f;
            case 1: return 3.2f * d.x * d.y * d.z + 0.9f * d.y * (5 * d.y * d.y - 3) * 0.5f;
            case 2:
                return 0.75f * std::sin(4 * d.x + 1) * std::sin(4 * d.y + 2) * std::sin(4 * d.z) +
                       0.5f * std::cos(5 * d.y + 2 * d.x);
            default: return 0;
        }
    }

    /// One topology for all forms; the poles' rings keep their vertices so that indices agree.
    Mesh ball(int target) const {
        const int rings = segments_ / 2;
        Mesh mesh;
        for (int j = 0; j <= rings; ++j)
            for (int i = 0; i <= segments_; ++i) {
                const float a = -2 * kPi * static_cast<float>(i % segments_) / static_cast<float>(segments_);
                const float b = kPi * static_cast<float>(j) / static_cast<float>(rings);
                const float ring = j == 0 || j == rings ? 0 : std::sin(b);
                const Vec3 d(ring * std::cos(a), j == rings ? 1 : -std::cos(b), ring * std::sin(a));
                mesh.positions.push_back(d * radius_ * (1 + swing_ * lobes(target, d)));
                mesh.uv[0].push_back({static_cast<float>(i) / static_cast<float>(segments_),
                                      static_cast<float>(j) / static_cast<float>(rings)});
            }
        const auto row = static_cast<uint32_t>(segments_ + 1);
        for (uint32_t j = 0; j < static_cast<uint32_t>(rings); ++j)
            for (uint32_t i = 0; i + 1 < row; ++i) {
                const uint32_t a = j * row + i;
                if (j > 0) mesh.triangles.push_back({a, a + 1, a + row + 1});
                if (j + 1 < static_cast<uint32_t>(rings)) mesh.triangles.push_back({a, a + row + 1, a + row});
            }
        smoothNormals(mesh, 180);
        return mesh;
    }

    Animation breathing() const {
        constexpr int kKeys = 48;
        AnimationChannel channel;
        channel.node = 0;
        channel.property = AnimatedProperty::MorphWeights;
        channel.components = kTargets;
        for (int k = 0; k <= kKeys; ++k) {
            const float w = 2 * kPi * static_cast<float>(k % kKeys) / kKeys;
            channel.times.push_back(period_ * static_cast<float>(k) / kKeys);
            channel.values.insert(channel.values.end(),
                                  {std::sin(w), 0.8f * std::sin(2 * w + 1), 0.6f * std::sin(w + 2.2f)});
        }
        Animation animation;
        animation.duration = period_;
        animation.channels.push_back(std::move(channel));
        return animation;
    }

    float radius_ = 0.5f, swing_ = 0.22f, period_ = 8;
    int segments_ = 128;
};

}  // namespace

std::unique_ptr<Procedural> makeBlob() { return std::make_unique<Blob>(); }

}  // namespace lumi
