#include "scene/procedural/generators.h"

namespace lumi {
namespace {

/// A toothed wheel about Z, centred on the origin: bevelled teeth, a raised rim, spokes over a sunken web, a hub.
class Gear final : public Procedural {
public:
    void describe(ParameterVisitor& v) override {
        describeLength(v, "radius", radius_, "Radius", 0.01, 20, "At the middle of the teeth");
        describeLength(v, "depth", depth_, "Depth", 0.005, 5, "Along the axle");
        describeCount(v, "teeth", teeth_, "Teeth", 5, 200, "Around");
        describeCount(v, "spokes", spokes_, "Spokes", 0, 24, "Between hub and rim");
    }

    ProceduralResult build() const override {
        Mesh mesh;
        const float pitch = 2 * kPi * radius_ / static_cast<float>(teeth_), tall = 0.30f * pitch;
        std::vector<Vec2> outline;
        for (int i = 0; i < teeth_; ++i) {
            const float step = 2 * kPi / static_cast<float>(teeth_), a = step * static_cast<float>(i);
            const auto point = [&](float t, float r) {
                outline.push_back({r * std::cos(a + t * step), r * std::sin(a + t * step)});
            };
            point(0.00f, radius_ - tall), point(0.14f, radius_ - tall), point(0.26f, radius_ + 0.3f * tall);
            point(0.34f, radius_ + tall), point(0.56f, radius_ + tall), point(0.64f, radius_ + 0.3f * tall);
            point(0.76f, radius_ - tall);
        }
        append(mesh, extrude(outline, Vec2(0), depth_ * 0.8f, depth_ * 0.05f));
        const float r = radius_ - 1.6f * tall, h = depth_ / 2;
        const Profile ring = smoothProfile({{r * 0.80f, -h, true},
                                            {r * 0.98f, -h},
                                            {r, -h * 0.95f},
                                            {r, h * 0.95f},
                                            {r * 0.98f, h},
                                            {r * 0.80f, h, true},
                                            {r * 0.78f, h * 0.9f},
                                            {r * 0.78f, -h * 0.9f},
                                            {r * 0.80f, -h, true}},
                                           2);
        append(mesh, lathe(ring, 96), 0, placed({0, 0, 0}, {90, 0, 0}));
        const Profile hub = smoothProfile({{0, -h * 1.3f},
                                           {r * 0.10f, -h * 1.3f, true},
                                           {r * 0.11f, -h * 1.25f},
                                           {r * 0.12f, -h, true},
                                           {r * 0.24f, -h * 1.05f, true},
                                           {r * 0.26f, -h},
                                           {r * 0.26f, h},
                                           {r * 0.24f, h * 1.05f, true},
                                           {r * 0.12f, h, true},
                                           {r * 0.11f, h * 1.25f},
                                           {r * 0.10f, h * 1.3f, true},
                                           {0, h * 1.3f}},
                                          2);
        append(mesh, lathe(hub, 48), 1, placed({0, 0, 0}, {90, 0, 0}));
        for (int i = 0; i < spokes_; ++i)
            append(mesh, roundedBox({r * 0.58f, r * 0.12f, depth_ * 0.96f}, depth_ * 0.12f, 3), 0,
                   placed({0, 0, 0}, {0, 0, 360 * static_cast<float>(i) / static_cast<float>(spokes_)}) *
                       placed({r * 0.51f, 0, 0}));
        return onePart(std::move(mesh), {opaqueSlot("surface", {0.80f, 0.60f, 0.28f}, 0.3f, 1),
                                         opaqueSlot("hub", {0.55f, 0.55f, 0.56f}, 0.25f, 1)});
    }

private:
    float radius_ = 0.5f, depth_ = 0.12f;
    int teeth_ = 24, spokes_ = 6;
};

/// A turned top that stands on its tip at the origin, in painted bands.
class SpinningTop final : public Procedural {
public:
    void describe(ParameterVisitor& v) override {
        describeLength(v, "radius", radius_, "Radius", 0.01, 10, "Of the body");
    }

    ProceduralResult build() const override {
        Mesh top = lathe(smoothProfile({{0, 0},
                                        {0.03f, 0.02f},
                                        {0.06f, 0.14f, true},
                                        {0.10f, 0.16f, true},
                                        {0.30f, 0.34f},
                                        {0.72f, 0.66f},
                                        {0.96f, 0.86f},
                                        {1.0f, 0.96f},
                                        {0.95f, 1.06f},
                                        {0.74f, 1.16f},
                                        {0.40f, 1.24f},
                                        {0.20f, 1.32f, true},
                                        {0.11f, 1.40f},
                                        {0.085f, 1.56f},
                                        {0.10f, 1.70f},
                                        {0.12f, 1.76f},
                                        {0.09f, 1.81f},
                                        {0, 1.82f}},
                                       6),
                         96);
        tidy(top);
        for (Vec3& p : top.positions) p *= radius_;
        top.triangleMaterial.clear();
        for (const UVec3& t : top.triangles) {
            const Vec3 middle = (top.positions[t.x] + top.positions[t.y] + top.positions[t.z]) / (3 * radius_);
            top.triangleMaterial.push_back(band(middle));
        }
        return onePart(std::move(top), {opaqueSlot("body", {0.55f, 0.03f, 0.03f}, 0.15f),
                                        opaqueSlot("stripe", {0.85f, 0.80f, 0.68f}, 0.15f),
                                        opaqueSlot("tip", {0.7f, 0.7f, 0.72f}, 0.15f, 1)});
    }

private:
    static uint32_t band(const Vec3& p) {
        if (p.y < 0.15f) return 2;
        // Wedges on the shoulder make the turning visible.
        const float angle = std::atan2(p.z, p.x), wedge = angle * 8 / (2 * kPi) + 8;
        if (p.y > 1.03f && p.y < 1.31f) return static_cast<uint32_t>(wedge) % 2;
        return p.y > 0.80f && p.y < 0.93f ? 1 : 0;
    }

    float radius_ = 0.3f;
};

}  // namespace

std::unique_ptr<Procedural> makeGear() { return std::make_unique<Gear>(); }
std::unique_ptr<Procedural> makeSpinningTop() { return std::make_unique<SpinningTop>(); }

}  // namespace lumi
