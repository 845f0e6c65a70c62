#include <algorithm>

#include "scene/procedural/generators.h"

namespace lumi {
namespace {

/// A rug on y = 0 that lies a little uneven, with a fringe at both ends of X. uv of the top runs from 0 to 1.
class Rug final : public Procedural {
public:
    void describe(ParameterVisitor& v) override {
        describeLength(v, "width", width_, "Width", 0.2, 20, "Along X, without the fringe");
        describeLength(v, "depth", depth_, "Depth", 0.2, 20, "Along Z");
        describeLength(v, "thickness", thickness_, "Thickness", 0.002, 0.1, "Of the pile");
        describeLength(v, "fringe", fringe_, "Fringe", 0, 0.3, "Length of the threads");
        describeSeed(v, seed_);
    }

    ProceduralResult build() const override {
        const auto seed = static_cast<uint32_t>(seed_);
        Mesh mesh;
        append(
            mesh,
            gridSurface(64, 48,
                        [&](float u, float v) {
                            const float edge = std::min({u * width_, (1 - u) * width_, v * depth_, (1 - v) * depth_});
                            const float rim = std::min(edge / 0.02f, 1.0f);
                            const float wave =
                                0.0025f * (1 + valueNoise(Vec3(u * width_ * 2.2f, 0, v * depth_ * 2.2f), seed));
                            return Vec3((u - 0.5f) * width_, rim * (thickness_ + wave) + 0.001f, (0.5f - v) * depth_);
                        }),
            0);
        if (fringe_ > 0) addFringe(mesh);
        return onePart(std::move(mesh), {opaqueSlot("surface", {0.45f, 0.13f, 0.10f}, 0.95f),
                                         opaqueSlot("fringe", {0.72f, 0.65f, 0.52f}, 0.95f)});
    }

private:
    void addFringe(Mesh& mesh) const {
        Dice dice(seed_);
        const int threads = static_cast<int>(depth_ / 0.012f);
        for (const float side : {-1.0f, 1.0f})
            for (int i = 0; i < threads; ++i) {
                const float z = depth_ * ((static_cast<float>(i) + 0.5f) / static_cast<float>(threads) - 0.5f);
                const float x = side * width_ / 2, reach = fringe_ * dice.range(0.8f, 1.1f);
                const Vec3 start(x - side * 0.01f, 0.005f, z);
                const Vec3 middle(x + side * reach * 0.5f, 0.0055f, z + dice.range(-0.004f, 0.004f));
                const Vec3 end(x + side * reach, 0.003f, z + dice.range(-0.012f, 0.012f));
                append(mesh, tube({start, middle, end}, {0.0028f, 0.0026f, 0.0018f}, 5, false), 1);
            }
    }

    float width_ = 2.4f, depth_ = 1.7f, thickness_ = 0.009f, fringe_ = 0.06f;
    int seed_ = 1;
};

}  // namespace

std::unique_ptr<Procedural> makeRug() { return std::make_unique<Rug>(); }

}  // namespace lumi
