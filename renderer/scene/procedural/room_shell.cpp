#include <array>

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

/// A room seen from inside: floor at y = 0, centred on the origin. The wall at -X has a window opening with a reveal
/// as deep as the wall; skirting boards and a cornice run around.
class RoomShell final : public Procedural {
public:
    void describe(ParameterVisitor& v) override {
        describeLength(v, "width", width_, "Width", 1, 50, "Along X, inside");
        describeLength(v, "depth", depth_, "Depth", 1, 50, "Along Z, inside");
        describeLength(v, "height", height_, "Height", 1.5, 20, "From floor to ceiling");
        describeLength(v, "wall", wall_, "Wall", 0.05, 1, "Thickness of the walls");
        describeLength(v, "window-width", windowWidth_, "Window width", 0.2, 20, "Of the opening, along Z");
        describeLength(v, "window-height", windowHeight_, "Window height", 0.2, 10, "Of the opening");
        describeLength(v, "window-sill", sill_, "Window sill", 0, 5, "Height of the opening's lower edge");
        describeLength(v, "window-z", windowZ_, "Window place", -25, 25, "Z of the opening's middle");
    }

    ProceduralResult build() const override {
        Mesh mesh;
        const float x = width_ / 2, z = depth_ / 2, h = height_, w = wall_;
        append(mesh, patch({-x, 0, z}, {width_, 0, 0}, {0, 0, -depth_}), kFloor);
        append(mesh, patch({-x, h, -z}, {width_, 0, 0}, {0, 0, depth_}), kCeiling);
        append(mesh, patch({-x, 0, -z}, {width_, 0, 0}, {0, h, 0}), kAccent);
        append(mesh, patch({x, 0, z}, {-width_, 0, 0}, {0, h, 0}), kWalls);
        append(mesh, patch({x, 0, -z}, {0, 0, depth_}, {0, h, 0}), kWalls);
        addWindowWall(mesh, x, z, h, w);
        addOutside(mesh, x, z, h, w);
        addMouldings(mesh, x, z, h);
        return onePart(
            std::move(mesh),
            {opaqueSlot("walls", {0.76f, 0.74f, 0.70f}, 0.9f), opaqueSlot("floor", {0.35f, 0.22f, 0.12f}, 0.4f),
             opaqueSlot("ceiling", {0.85f, 0.84f, 0.82f}, 0.95f), opaqueSlot("trim", {0.82f, 0.81f, 0.78f}, 0.4f),
             opaqueSlot("accent", {0.76f, 0.74f, 0.70f}, 0.9f)});
    }

private:
    void addWindowWall(Mesh& mesh, float x, float z, float h, float w) const {
        const float z0 = windowZ_ - windowWidth_ / 2, z1 = windowZ_ + windowWidth_ / 2;
        const float y0 = sill_, y1 = sill_ + windowHeight_;
        // Four panels around the opening, facing +X.
        append(mesh, patch({-x, 0, z}, {0, 0, -depth_}, {0, y0, 0}), kWalls);
        append(mesh, patch({-x, y1, z}, {0, 0, -depth_}, {0, h - y1, 0}), kWalls);
        append(mesh, patch({-x, y0, z}, {0, 0, z1 - z}, {0, y1 - y0, 0}), kWalls);
        append(mesh, patch({-x, y0, z0}, {0, 0, -z - z0}, {0, y1 - y0, 0}), kWalls);
        // The reveal: bottom, top and both sides of the opening, through the wall.
        append(mesh, patch({-x - w, y0, z1}, {w, 0, 0}, {0, 0, z0 - z1}), kTrim);
        append(mesh, patch({-x - w, y1, z0}, {w, 0, 0}, {0, 0, z1 - z0}), kWalls);
        append(mesh, patch({-x - w, y0, z0}, {w, 0, 0}, {0, y1 - y0, 0}), kWalls);
        append(mesh, patch({-x, y0, z1}, {-w, 0, 0}, {0, y1 - y0, 0}), kWalls);
    }

    /// Plain outer faces, so that light from outside comes in through the opening only.
    void addOutside(Mesh& mesh, float x, float z, float h, float w) const {
        const float X = x + w, Z = z + w, H = h + w, y0 = sill_, y1 = sill_ + windowHeight_;
        const float z0 = windowZ_ - windowWidth_ / 2, z1 = windowZ_ + windowWidth_ / 2;
        append(mesh, patch({-X, H, Z}, {2 * X, 0, 0}, {0, 0, -2 * Z}), kWalls);
        append(mesh, patch({-X, -w, -Z}, {2 * X, 0, 0}, {0, 0, 2 * Z}), kWalls);
        append(mesh, patch({X, -w, -Z}, {-2 * X, 0, 0}, {0, H + w, 0}), kWalls);
        append(mesh, patch({-X, -w, Z}, {2 * X, 0, 0}, {0, H + w, 0}), kWalls);
        append(mesh, patch({X, -w, Z}, {0, 0, -2 * Z}, {0, H + w, 0}), kWalls);
        append(mesh, patch({-X, -w, -Z}, {0, 0, 2 * Z}, {0, y0 + w, 0}), kWalls);
        append(mesh, patch({-X, y1, -Z}, {0, 0, 2 * Z}, {0, H - y1, 0}), kWalls);
        append(mesh, patch({-X, y0, -Z}, {0, 0, z0 + Z}, {0, y1 - y0, 0}), kWalls);
        append(mesh, patch({-X, y0, z1}, {0, 0, Z - z1}, {0, y1 - y0, 0}), kWalls);
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

    float width_ = 6, depth_ = 5, height_ = 2.8f, wall_ = 0.25f;
    float windowWidth_ = 2.2f, windowHeight_ = 1.7f, sill_ = 0.75f, windowZ_ = 0;
};

}  // namespace

std::unique_ptr<Procedural> makeRoomShell() {
    return std::make_unique<RoomShell>();
}

}  // namespace lumi
