#include "scene/procedural/generators.h"

namespace lumi {
namespace {

constexpr uint32_t kWalls = 0, kFloor = 1, kCeiling = 2, kTrim = 3, kAccent = 4;

/// A flat patch with the front where right x up points; uv in metres from its corner.
Mesh patch(const Vec3& corner, const Vec3& right, const Vec3& up) {
    const Vec2 scale(glm::length(right), glm::length(up));
    return gridSurface(
        1, 1, [&](float u, float v) { return corner + right * u + up * v; }, scale);
}

/// A room seen from inside: floor at y = 0, centred on the origin. The walls at -X and +Z have window openings with
/// reveals as deep as the walls; skirting boards and a cornice run around. The wall at -Z is the accent.
class RoomShell final : public Procedural {
public:
    void describe(ParameterVisitor& v) override {
        describeLength(v, "width", width_, "Width", 1, 50, "Along X, inside");
        describeLength(v, "depth", depth_, "Depth", 1, 50, "Along Z, inside");
        describeLength(v, "height", height_, "Height", 1.5, 20, "From floor to ceiling");
        describeLength(v, "wall", wall_, "Wall", 0.05, 1, "Thickness of the walls");
        describeLength(v, "window-width", side_.width, "Window width", 0.2, 20, "Of the opening at -X, along Z");
        describeLength(v, "window-height", side_.height, "Window height", 0.2, 10, "Of the opening at -X");
        describeLength(v, "window-sill", side_.sill, "Window sill", 0, 5, "Height of that opening's lower edge");
        describeLength(v, "window-z", windowZ_, "Window place", -25, 25, "Z of that opening's middle");
        describeLength(v, "front-width", front_.width, "Front width", 0.2, 20, "Of the opening at +Z, along X");
        describeLength(v, "front-height", front_.height, "Front height", 0.2, 10, "Of the opening at +Z");
        describeLength(v, "front-sill", front_.sill, "Front sill", 0, 5, "Height of that opening's lower edge");
        describeLength(v, "front-x", frontX_, "Front place", -25, 25, "X of that opening's middle");
    }

    ProceduralResult build() const override {
        Mesh mesh;
        const float x = width_ / 2, z = depth_ / 2, h = height_, w = wall_;
        append(mesh, patch({-x, 0, z}, {width_, 0, 0}, {0, 0, -depth_}), kFloor);
        append(mesh, patch({-x, h, -z}, {width_, 0, 0}, {0, 0, depth_}), kCeiling);
        append(mesh, patch({-x - w, h + w, z + w}, {width_ + 2 * w, 0, 0}, {0, 0, -depth_ - 2 * w}), kWalls);
        append(mesh, patch({-x - w, -w, -z - w}, {width_ + 2 * w, 0, 0}, {0, 0, depth_ + 2 * w}), kWalls);
        Opening side = side_, front = front_, none;
        side.at = -windowZ_, front.at = -frontX_, none.width = 0;
        append(mesh, wall(width_, none, kAccent), 0, placed({0, 0, -z}));
        append(mesh, wall(depth_, side, kWalls), 0, placed({-x, 0, 0}, {0, 90, 0}));
        append(mesh, wall(width_, front, kWalls), 0, placed({0, 0, z}, {0, 180, 0}));
        append(mesh, wall(depth_, none, kWalls), 0, placed({x, 0, 0}, {0, -90, 0}));
        addMouldings(mesh, x, z, h);
        return onePart(
            std::move(mesh),
            {opaqueSlot("walls", {0.76f, 0.74f, 0.70f}, 0.9f), opaqueSlot("floor", {0.35f, 0.22f, 0.12f}, 0.4f),
             opaqueSlot("ceiling", {0.85f, 0.84f, 0.82f}, 0.95f), opaqueSlot("trim", {0.82f, 0.81f, 0.78f}, 0.4f),
             opaqueSlot("accent", {0.76f, 0.74f, 0.70f}, 0.9f)});
    }

private:
    /// A window opening in a wall; no width means none.
    struct Opening {
        float width = 2.2f, height = 1.7f, sill = 0.75f;
        float at = 0;  ///< of its middle along the wall, to the right seen from inside
    };

    /// A wall of two faces, `length` along X about the origin, its inner face on z = 0 towards +Z; the outer one
    /// reaches around the corners. Light comes in through the opening only.
    Mesh wall(float length, const Opening& opening, uint32_t slot) const {
        Mesh mesh;
        const float x = length / 2, X = x + wall_, h = height_, w = wall_;
        if (opening.width <= 0) {
            append(mesh, patch({-x, 0, 0}, {2 * x, 0, 0}, {0, h, 0}), slot);
            append(mesh, patch({X, -w, -w}, {-2 * X, 0, 0}, {0, h + 2 * w, 0}), kWalls);
            return mesh;
        }
        const float x0 = opening.at - opening.width / 2, x1 = opening.at + opening.width / 2;
        const float y0 = opening.sill, y1 = opening.sill + opening.height;
        // Four panels around the opening on each face.
        append(mesh, patch({-x, 0, 0}, {2 * x, 0, 0}, {0, y0, 0}), slot);
        append(mesh, patch({-x, y1, 0}, {2 * x, 0, 0}, {0, h - y1, 0}), slot);
        append(mesh, patch({-x, y0, 0}, {x0 + x, 0, 0}, {0, y1 - y0, 0}), slot);
        append(mesh, patch({x1, y0, 0}, {x - x1, 0, 0}, {0, y1 - y0, 0}), slot);
        append(mesh, patch({X, -w, -w}, {-2 * X, 0, 0}, {0, y0 + w, 0}), kWalls);
        append(mesh, patch({X, y1, -w}, {-2 * X, 0, 0}, {0, h + w - y1, 0}), kWalls);
        append(mesh, patch({x0, y0, -w}, {-X - x0, 0, 0}, {0, y1 - y0, 0}), kWalls);
        append(mesh, patch({X, y0, -w}, {x1 - X, 0, 0}, {0, y1 - y0, 0}), kWalls);
        // The reveal through the wall: bottom, top and both sides.
        append(mesh, patch({x0, y0, 0}, {x1 - x0, 0, 0}, {0, 0, -w}), kTrim);
        append(mesh, patch({x0, y1, -w}, {x1 - x0, 0, 0}, {0, 0, w}), slot);
        append(mesh, patch({x0, y0, 0}, {0, 0, -w}, {0, y1 - y0, 0}), slot);
        append(mesh, patch({x1, y0, -w}, {0, 0, w}, {0, y1 - y0, 0}), slot);
        return mesh;
    }

    void addMouldings(Mesh& mesh, float x, float z, float h) const {
        const std::vector<Vec3> floorPath = {{-x, 0, -z}, {x, 0, -z}, {x, 0, z}, {-x, 0, z}, {-x, 0, -z}};
        const std::vector<Vec3> inward = {{1, 0, 1}, {-1, 0, 1}, {-1, 0, -1}, {1, 0, -1}, {1, 0, 1}};
        std::vector<Vec3> ceilingPath = floorPath;
        for (Vec3& p : ceilingPath) p.y = h;
        const std::vector<Vec2> skirting = {{0.018f, 0},      {0.018f, 0.085f}, {0.016f, 0.090f}, {0.012f, 0.092f},
                                            {0.010f, 0.098f}, {0.010f, 0.108f}, {0.006f, 0.114f}, {0, 0.116f}};
        const std::vector<Vec2> cornice = {{0, -0.110f},      {0.012f, -0.108f}, {0.014f, -0.094f}, {0.020f, -0.090f},
                                           {0.030f, -0.062f}, {0.052f, -0.036f}, {0.078f, -0.024f}, {0.082f, -0.018f},
                                           {0.094f, -0.016f}, {0.096f, 0}};
        append(mesh, moulding(skirting, floorPath, inward, {0, 1, 0}), kTrim);
        append(mesh, moulding(cornice, ceilingPath, inward, {0, 1, 0}), kTrim);
    }

    float width_ = 6, depth_ = 5, height_ = 2.8f, wall_ = 0.25f, windowZ_ = 0, frontX_ = 0;
    Opening side_, front_;
};

}  // namespace

std::unique_ptr<Procedural> makeRoomShell() { return std::make_unique<RoomShell>(); }

}  // namespace lumi
