#include <algorithm>

#include "scene/procedural/generators.h"

namespace lumi {
namespace {

constexpr uint32_t kTop = 0, kLegs = 1;

/// A table: softly rounded top, slanted round legs joined by an apron, optionally a shelf below.
class Table final : public Procedural {
public:
    void describe(ParameterVisitor& v) override {
        describeLength(v, "width", width_, "Width", 0.2, 5, "Along X");
        describeLength(v, "depth", depth_, "Depth", 0.2, 5, "Along Z");
        describeLength(v, "height", height_, "Height", 0.1, 1.5, "Of the top face");
        describeLength(v, "thickness", thickness_, "Thickness", 0.005, 0.2, "Of the top");
        v.toggle("round", round_, {.label = "Round", .help = "A round top on four legs", .redo = Redo::Build});
        v.toggle("shelf", shelf_, {.label = "Shelf", .help = "A slatted shelf between the legs", .redo = Redo::Build});
    }

    ProceduralResult build() const override {
        Mesh mesh;
        if (round_) {
            const float r = width_ / 2, t = thickness_;
            const Profile edge = {{0, height_ - t},
                                  {r - 0.02f, height_ - t, true},
                                  {r - 0.004f, height_ - 0.7f * t},
                                  {r, height_ - 0.4f * t},
                                  {r - 0.003f, height_ - 0.1f * t},
                                  {r - 0.012f, height_, true},
                                  {0, height_}};
            Mesh top = lathe(smoothProfile(edge, 3), 96);
            for (size_t i = 0; i < top.positions.size(); ++i)
                if (std::abs(top.normals[i].y) > 0.9f) top.uv[0][i] = {top.positions[i].x, top.positions[i].z};
            append(mesh, top, kTop, Mat4(1));
        } else {
            append(mesh, roundedBox({width_, thickness_, depth_}, std::min(0.012f, thickness_ * 0.4f), 4), kTop,
                   placed({0, height_ - thickness_ / 2, 0}));
        }
        const float x = round_ ? width_ * 0.30f : width_ / 2 - 0.09f, z = round_ ? width_ * 0.30f : depth_ / 2 - 0.09f;
        const float under = height_ - thickness_;
        for (const float sx : {-1.0f, 1.0f})
            for (const float sz : {-1.0f, 1.0f})
                append(mesh,
                       tube({Vec3(sx * (x + 0.045f), 0.012f, sz * (z + 0.045f)), Vec3(sx * x, under, sz * z)},
                            {0.013f, 0.024f}, 20),
                       kLegs);
        const float apron = std::min(0.06f, under * 0.2f);
        for (const float s : {-1.0f, 1.0f}) {
            append(mesh, roundedBox({2 * x, apron, 0.02f}, 0.003f, 2), kLegs, placed({0, under - apron / 2, s * z}));
            append(mesh, roundedBox({0.02f, apron, 2 * z}, 0.003f, 2), kLegs, placed({s * x, under - apron / 2, 0}));
        }
        if (shelf_) addShelf(mesh, x, z);
        return onePart(std::move(mesh), {opaqueSlot("top", {0.36f, 0.20f, 0.10f}, 0.35f),
                                         opaqueSlot("legs", {0.16f, 0.08f, 0.04f}, 0.4f)});
    }

private:
    void addShelf(Mesh& mesh, float x, float z) const {
        const float y = height_ * 0.38f;
        const int slats = std::max(3, static_cast<int>(2 * z / 0.075f));
        for (int i = 0; i < slats; ++i) {
            const float at = -z + 2 * z * (static_cast<float>(i) + 0.5f) / static_cast<float>(slats);
            append(mesh, roundedBox({2 * x + 0.03f, 0.014f, 0.05f}, 0.004f, 2), kLegs, placed({0, y, at}));
        }
        for (const float s : {-1.0f, 1.0f})
            append(mesh, roundedBox({0.025f, 0.02f, 2 * z + 0.03f}, 0.004f, 2), kLegs, placed({s * x, y - 0.016f, 0}));
    }

    float width_ = 1.2f, depth_ = 0.65f, height_ = 0.42f, thickness_ = 0.032f;
    bool round_ = false, shelf_ = false;
};

}  // namespace

std::unique_ptr<Procedural> makeTable() { return std::make_unique<Table>(); }

}  // namespace lumi
