#include <cmath>
#include <utility>

#include "base/error.h"
#include "scene/procedural/mesh_builder.h"
#include "scene/procedural/primitives.h"

// Shapes of revolution about +Y. Columns run counter-clockwise seen from above, rows upwards, u to the right and v
// downwards seen from outside.
namespace lumi {
namespace {

/// Parameters that several shapes share.
void describeRadius(ParameterVisitor& v, float& radius) {
    v.number("radius", radius,
             {.label = "Radius",
              .min = 1e-4,
              .max = 1e4,
              .scale = Scale::Log,
              .unit = "m",
              .help = "Distance of the surface from its axis or centre.",
              .redo = Redo::Build});
}
void describeHeight(ParameterVisitor& v, float& height) {
    v.number("height", height,
             {.label = "Height",
              .min = 1e-4,
              .max = 1e4,
              .scale = Scale::Log,
              .unit = "m",
              .help = "Extent along Y; the centre is the origin.",
              .redo = Redo::Build});
}
void describeSegments(ParameterVisitor& v, int& segments) {
    v.integer("segments", segments,
              {.label = "Segments",
               .min = 3,
               .max = 4096,
               .scale = Scale::Log,
               .help = "Facets once around the axis.",
               .redo = Redo::Build});
}
void describeCaps(ParameterVisitor& v, bool& caps) {
    v.toggle("caps", caps, {.label = "Caps", .help = "Closes the ends with flat disks.", .redo = Redo::Build});
}

class Sphere : public Procedural {
public:
    void describe(ParameterVisitor& v) override {
        describeRadius(v, radius_);
        describeSegments(v, segments_);
        v.integer("rings", rings_,
                  {.label = "Rings",
                   .min = 2,
                   .max = 2048,
                   .scale = Scale::Log,
                   .help = "Facets from pole to pole.",
                   .redo = Redo::Build});
    }
    ProceduralResult build() const override { return singleMesh(sphereMesh(radius_, segments_, rings_)); }

private:
    float radius_ = 0.5f;
    int segments_ = 128, rings_ = 64;
};

class Cylinder : public Procedural {
public:
    void describe(ParameterVisitor& v) override {
        describeRadius(v, radius_);
        describeHeight(v, height_);
        describeSegments(v, segments_);
        describeCaps(v, caps_);
    }
    ProceduralResult build() const override {
        return singleMesh(frustumMesh(radius_, radius_, height_, segments_, caps_));
    }

private:
    float radius_ = 0.5f, height_ = 1;
    int segments_ = 96;
    bool caps_ = true;
};

class Cone : public Procedural {
public:
    void describe(ParameterVisitor& v) override {
        describeRadius(v, radius_);
        v.number("top-radius", topRadius_,
                 {.label = "Top radius",
                  .min = 0,
                  .max = 1e4,
                  .unit = "m",
                  .help = "Radius at the upper end; 0 is a point.",
                  .redo = Redo::Build});
        describeHeight(v, height_);
        describeSegments(v, segments_);
        describeCaps(v, caps_);
    }
    ProceduralResult build() const override {
        return singleMesh(frustumMesh(radius_, topRadius_, height_, segments_, caps_));
    }

private:
    float radius_ = 0.5f, topRadius_ = 0, height_ = 1;
    int segments_ = 96;
    bool caps_ = true;
};

class Torus : public Procedural {
public:
    void describe(ParameterVisitor& v) override {
        describeRadius(v, radius_);
        v.number("tube-radius", tubeRadius_,
                 {.label = "Tube radius",
                  .min = 1e-4,
                  .max = 1e4,
                  .scale = Scale::Log,
                  .unit = "m",
                  .help = "Radius of the tube; below the ring's radius.",
                  .redo = Redo::Build});
        describeSegments(v, segments_);
        v.integer("tube-segments", tubeSegments_,
                  {.label = "Tube segments",
                   .min = 3,
                   .max = 2048,
                   .scale = Scale::Log,
                   .help = "Facets once around the tube.",
                   .redo = Redo::Build});
    }
    ProceduralResult build() const override {
        if (tubeRadius_ >= radius_)
            throwUsage({"\"tube-radius\" is not below \"radius\"", "", "", formatParameter(tubeRadius_)});
        return singleMesh(torusMesh(radius_, tubeRadius_, segments_, tubeSegments_));
    }

private:
    float radius_ = 0.5f, tubeRadius_ = 0.2f;
    int segments_ = 96, tubeSegments_ = 48;
};

/// A point of the circle in the XZ plane, counter-clockwise seen from +Y.
Vec3 ringDirection(int index, int count) {
    const Vec2 c = circlePoint(index, count);
    return {c.x, 0, -c.y};
}

void addCap(MeshBuilder& builder, float radius, float y, int segments, bool top) {
    const Vec3 normal(0, top ? 1 : -1, 0);
    const uint32_t centre = builder.addVertex({Vec3(0, y, 0), normal, Vec2(0.5f)});
    uint32_t previous = 0;
    for (int i = 0; i <= segments; ++i) {
        const Vec3 d = ringDirection(i, segments);
        const uint32_t rim = builder.addVertex(
            {Vec3(radius * d.x, y, radius * d.z), normal, Vec2(0.5f) + 0.5f * Vec2(d.x, top ? d.z : -d.z)});
        if (i > 0) builder.addTriangle(centre, top ? previous : rim, top ? rim : previous);
        previous = rim;
    }
}

}  // namespace

Mesh sphereMesh(float radius, int segments, int rings) {
    MeshBuilder builder;
    builder.addGrid(segments, rings, [&](int column, int row) {
        // Rings are points of a circle of 2 * rings, from the south pole up.
        const Vec2 meridian = circlePoint(row, 2 * rings);
        const bool pole = row == 0 || row == rings;
        const Vec3 around = ringDirection(column, segments);
        const float sine = pole ? 0 : meridian.y;
        const Vec3 normal(around.x * sine, -meridian.x, around.z * sine);
        const float u = (static_cast<float>(column) + (pole ? 0.5f : 0)) / static_cast<float>(segments);
        return SurfaceVertex{radius * normal, glm::normalize(normal),
                             Vec2(u, 1 - static_cast<float>(row) / static_cast<float>(rings))};
    });
    return builder.take("sphere");
}

Mesh frustumMesh(float bottomRadius, float topRadius, float height, int segments, bool caps) {
    MeshBuilder builder;
    const float slope = (bottomRadius - topRadius) / height;
    // Cones get rows so that the interpolated normals of the thin triangles at the tip stay close to the surface's.
    const int rows = bottomRadius == topRadius ? 1 : 8;
    builder.addGrid(segments, rows, [&](int column, int row) {
        const float t = static_cast<float>(row) / static_cast<float>(rows);
        const float radius = row == rows ? topRadius : glm::mix(bottomRadius, topRadius, t);
        const Vec3 d = ringDirection(column, segments);
        return SurfaceVertex{Vec3(radius * d.x, (t - 0.5f) * height, radius * d.z),
                             glm::normalize(Vec3(d.x, slope, d.z)),
                             Vec2(static_cast<float>(column) / static_cast<float>(segments), 1 - t)};
    });
    if (caps && bottomRadius > 0) addCap(builder, bottomRadius, -0.5f * height, segments, false);
    if (caps && topRadius > 0) addCap(builder, topRadius, 0.5f * height, segments, true);
    return builder.take("cylinder");
}

Mesh torusMesh(float radius, float tubeRadius, int segments, int tubeSegments) {
    MeshBuilder builder;
    builder.addGrid(segments, tubeSegments, [&](int column, int row) {
        const Vec3 d = ringDirection(column, segments);
        const Vec2 tube = circlePoint(row, tubeSegments);
        const Vec3 normal(d.x * tube.x, tube.y, d.z * tube.x);
        return SurfaceVertex{radius * d + tubeRadius * normal, glm::normalize(normal),
                             Vec2(static_cast<float>(column) / static_cast<float>(segments),
                                  1 - static_cast<float>(row) / static_cast<float>(tubeSegments))};
    });
    return builder.take("torus");
}

std::unique_ptr<Procedural> makeSphere() { return std::make_unique<Sphere>(); }
std::unique_ptr<Procedural> makeCylinder() { return std::make_unique<Cylinder>(); }
std::unique_ptr<Procedural> makeCone() { return std::make_unique<Cone>(); }
std::unique_ptr<Procedural> makeTorus() { return std::make_unique<Torus>(); }

}  // namespace lumi
