#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "scene/procedural/mesh_builder.h"
#include "scene/procedural/primitives.h"

namespace lumi {
namespace {

void describeSide(ParameterVisitor& v, const char* id, const char* label, float& value, const char* help) {
    v.number(
        id, value,
        {.label = label, .min = 1e-4, .max = 1e4, .scale = Scale::Log, .unit = "m", .help = help, .redo = Redo::Build});
}
void describeFacing(ParameterVisitor& v, Facing& facing) {
    v.choice("facing", facing,
             {.label = "Facing",
              .options = {"x", "-x", "y", "-y", "z", "-z"},
              .help = "Axis that the front points along; y is a floor.",
              .redo = Redo::Build});
}
void describeMetres(ParameterVisitor& v, bool& metres) {
    v.toggle("uv-in-metres", metres,
             {.label = "UV in metres",
              .help = "Texture coordinates count metres; otherwise each face spans 0 to 1.",
              .redo = Redo::Build});
}

class Rectangle : public Procedural {
public:
    void describe(ParameterVisitor& v) override {
        describeSide(v, "width", "Width", width_, "Full width.");
        describeSide(v, "height", "Height", height_, "Full height; for a floor its depth.");
        describeFacing(v, facing_);
        describeMetres(v, metres_);
    }
    ProceduralResult build() const override {
        return singleMesh(rectangleMesh(width_, height_, facing_, 1, 1, metres_));
    }

private:
    float width_ = 1, height_ = 1;
    Facing facing_ = Facing::Y;
    bool metres_ = false;
};

class PlaneGrid : public Procedural {
public:
    void describe(ParameterVisitor& v) override {
        describeSide(v, "width", "Width", width_, "Full width.");
        describeSide(v, "height", "Height", height_, "Full height; for a floor its depth.");
        describeFacing(v, facing_);
        v.integer("columns", columns_,
                  {.label = "Columns",
                   .min = 1,
                   .max = 4096,
                   .scale = Scale::Log,
                   .help = "Quads along the width.",
                   .redo = Redo::Build});
        v.integer("rows", rows_,
                  {.label = "Rows",
                   .min = 1,
                   .max = 4096,
                   .scale = Scale::Log,
                   .help = "Quads along the height.",
                   .redo = Redo::Build});
        describeMetres(v, metres_);
    }
    ProceduralResult build() const override {
        return singleMesh(rectangleMesh(width_, height_, facing_, columns_, rows_, metres_));
    }

private:
    float width_ = 10, height_ = 10;
    Facing facing_ = Facing::Y;
    int columns_ = 10, rows_ = 10;
    bool metres_ = false;
};

class Disk : public Procedural {
public:
    void describe(ParameterVisitor& v) override {
        describeSide(v, "radius", "Radius", radius_, "Outer radius.");
        v.number("inner-radius", innerRadius_,
                 {.label = "Inner radius",
                  .min = 0,
                  .max = 1e4,
                  .unit = "m",
                  .help = "Radius of the hole; 0 is a full disk.",
                  .redo = Redo::Build});
        describeFacing(v, facing_);
        v.integer("segments", segments_,
                  {.label = "Segments",
                   .min = 3,
                   .max = 4096,
                   .scale = Scale::Log,
                   .help = "Facets once around.",
                   .redo = Redo::Build});
    }
    ProceduralResult build() const override {
        if (innerRadius_ >= radius_)
            throwUsage({"\"inner-radius\" is not below \"radius\"", "", "", formatParameter(innerRadius_)});
        return singleMesh(diskMesh(radius_, innerRadius_, facing_, segments_));
    }

private:
    float radius_ = 0.5f, innerRadius_ = 0;
    Facing facing_ = Facing::Y;
    int segments_ = 96;
};

class Box : public Procedural {
public:
    void describe(ParameterVisitor& v) override {
        describeSide(v, "width", "Width", size_.x, "Full extent along X.");
        describeSide(v, "height", "Height", size_.y, "Full extent along Y.");
        describeSide(v, "depth", "Depth", size_.z, "Full extent along Z.");
        v.number("bevel", bevel_,
                 {.label = "Bevel",
                  .min = 0,
                  .max = 1e3,
                  .unit = "m",
                  .help = "Radius of the rounded edges; 0 keeps them sharp.",
                  .redo = Redo::Build});
        v.when(bevel_ > 0, [&] {
            v.integer("bevel-segments", bevelSegments_,
                      {.label = "Bevel segments",
                       .min = 1,
                       .max = 64,
                       .help = "Strips in half of a rounded edge.",
                       .redo = Redo::Build});
        });
        describeMetres(v, metres_);
    }
    ProceduralResult build() const override {
        if (2 * bevel_ > minComponent(size_) * 1.000001f)
            throwUsage({"\"bevel\" is more than half of the smallest side", "",
                        "at most " + formatParameter(0.5f * minComponent(size_)), formatParameter(bevel_)});
        return singleMesh(boxMesh(size_, bevel_, bevelSegments_, metres_));
    }

private:
    Vec3 size_{1};
    float bevel_ = 0;
    int bevelSegments_ = 3;
    bool metres_ = false;
};

/// One coordinate of a box face: where its inner corner is, and how far the rounded edge has turned (tangent).
struct BevelStop {
    float inner;
    float tangent;
};

/// Stops along a side of length `size`: the lower rounded edge, then the upper, mirrored bit by bit.
std::vector<BevelStop> bevelStops(float size, float bevel, int segments) {
    const float inner = std::max(0.5f * size - bevel, 0.0f);
    if (bevel <= 0) return {{-inner, 0}, {inner, 0}};
    std::vector<BevelStop> stops(static_cast<size_t>(2 * segments + 2));
    for (int i = 0; i <= segments; ++i) {
        const float angle = 0.25f * kPi * static_cast<float>(i) / static_cast<float>(segments);
        const float tangent = i == 0 ? 0 : i == segments ? 1 : std::tan(angle);
        stops[static_cast<size_t>(segments - i)] = {-inner, -tangent};
        stops[static_cast<size_t>(segments + 1 + i)] = {inner, tangent};
    }
    return stops;
}

/// Unit vector whose bits do not depend on the order of the components, so that faces meet exactly.
Vec3 orderedNormalize(const Vec3& v) {
    std::array<float, 3> squares{v.x * v.x, v.y * v.y, v.z * v.z};
    std::sort(squares.begin(), squares.end());
    return v / std::sqrt(squares[0] + squares[1] + squares[2]);
}

}  // namespace

Mat3 facingBasis(Facing facing) {
    const Vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    switch (facing) {
        case Facing::X: return Mat3(-z, y, x);
        case Facing::MinusX: return Mat3(z, y, -x);
        case Facing::Y: return Mat3(x, -z, y);
        case Facing::MinusY: return Mat3(x, z, -y);
        case Facing::Z: return Mat3(x, y, z);
        case Facing::MinusZ: return Mat3(-x, y, -z);
    }
    return Mat3(1);
}

Mesh rectangleMesh(float width, float height, Facing facing, int columns, int rows, bool uvInMetres) {
    const Mat3 basis = facingBasis(facing);
    const Vec2 uvScale = uvInMetres ? Vec2(width, height) : Vec2(1);
    MeshBuilder builder;
    builder.addGrid(columns, rows, [&](int column, int row) {
        const float s = static_cast<float>(column) / static_cast<float>(columns);
        const float t = static_cast<float>(row) / static_cast<float>(rows);
        return SurfaceVertex{basis[0] * ((s - 0.5f) * width) + basis[1] * ((t - 0.5f) * height), basis[2],
                             Vec2(s, 1 - t) * uvScale};
    });
    return builder.take("rectangle");
}

Mesh diskMesh(float radius, float innerRadius, Facing facing, int segments) {
    const Mat3 basis = facingBasis(facing);
    const auto vertex = [&](float r, int column) {
        const Vec2 c = circlePoint(column, segments);
        return SurfaceVertex{r * (basis[0] * c.x + basis[1] * c.y), basis[2],
                             Vec2(0.5f) + 0.5f * r / radius * Vec2(c.x, -c.y)};
    };
    MeshBuilder builder;
    if (innerRadius > 0) {
        // Rows run outwards, columns clockwise: the front stays on the normal's side.
        builder.addGrid(segments, 1, [&](int column, int row) {
            return vertex(row == 0 ? innerRadius : radius, segments - column);
        });
        return builder.take("disk");
    }
    const uint32_t centre = builder.addVertex(vertex(0, 0));
    uint32_t previous = builder.addVertex(vertex(radius, 0));
    for (int i = 1; i <= segments; ++i) {
        const uint32_t rim = builder.addVertex(vertex(radius, i));
        builder.addTriangle(centre, previous, rim);
        previous = rim;
    }
    return builder.take("disk");
}

Mesh boxMesh(const Vec3& size, float bevel, int bevelSegments, bool uvInMetres) {
    MeshBuilder builder;
    for (const Facing facing : {Facing::X, Facing::MinusX, Facing::Y, Facing::MinusY, Facing::Z, Facing::MinusZ}) {
        const Mat3 basis = facingBasis(facing);
        const float width = std::abs(glm::dot(basis[0], size)), height = std::abs(glm::dot(basis[1], size));
        const float depth = std::abs(glm::dot(basis[2], size));
        const std::vector<BevelStop> across = bevelStops(width, bevel, bevelSegments);
        const std::vector<BevelStop> up = bevelStops(height, bevel, bevelSegments);
        const float innerDepth = std::max(0.5f * depth - bevel, 0.0f);
        const Vec2 extent = uvInMetres ? Vec2(1) : Vec2(width, height);
        builder.addGrid(static_cast<int>(across.size()) - 1, static_cast<int>(up.size()) - 1, [&](int c, int r) {
            const BevelStop a = across[static_cast<size_t>(c)], b = up[static_cast<size_t>(r)];
            const Vec3 turned = orderedNormalize(Vec3(a.tangent, b.tangent, 1));
            const Vec3 local = Vec3(a.inner, b.inner, innerDepth) + bevel * turned;
            // The basis only swaps and negates axes, so no rounding separates neighbouring faces.
            return SurfaceVertex{basis * local, basis * turned,
                                 Vec2(local.x + 0.5f * width, 0.5f * height - local.y) / extent};
        });
    }
    return builder.take("box");
}

std::unique_ptr<Procedural> makeRectangle() { return std::make_unique<Rectangle>(); }
std::unique_ptr<Procedural> makePlaneGrid() { return std::make_unique<PlaneGrid>(); }
std::unique_ptr<Procedural> makeDisk() { return std::make_unique<Disk>(); }
std::unique_ptr<Procedural> makeBox() { return std::make_unique<Box>(); }

}  // namespace lumi
