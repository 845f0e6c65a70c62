#include <array>

#include "scene/procedural/generators.h"

namespace lumi {
namespace {

enum class VesselKind { Vase, Bottle, Bowl, Urn, Plate, Candlestick, Cup, Pot };

/// Outer contours for a height of 1, bottom to rim; the foot's first point is on the ground.
Profile outerContour(VesselKind kind) {
    switch (kind) {
        case VesselKind::Vase:
            return {{0.17f, 0, true}, {0.19f, 0.02f},  {0.27f, 0.20f}, {0.335f, 0.46f}, {0.29f, 0.70f},
                    {0.15f, 0.85f},   {0.115f, 0.91f}, {0.13f, 0.97f}, {0.165f, 1}};
        case VesselKind::Bottle:
            return {{0.20f, 0, true}, {0.23f, 0.015f}, {0.30f, 0.12f},  {0.31f, 0.25f},  {0.23f, 0.42f},
                    {0.10f, 0.55f},   {0.065f, 0.70f}, {0.060f, 0.88f}, {0.075f, 0.96f}, {0.105f, 1}};
        case VesselKind::Bowl:
            return {{0.42f, 0, true}, {0.43f, 0.05f}, {0.40f, 0.10f, true}, {0.62f, 0.20f}, {0.90f, 0.45f},
                    {1.08f, 0.75f},   {1.17f, 1}};
        case VesselKind::Urn:
            return {{0.26f, 0, true}, {0.26f, 0.04f, true},  {0.23f, 0.06f},         {0.12f, 0.13f},
                    {0.095f, 0.18f},  {0.13f, 0.21f, true},  {0.135f, 0.235f, true}, {0.11f, 0.25f},
                    {0.26f, 0.36f},   {0.375f, 0.52f},       {0.38f, 0.62f, true},   {0.40f, 0.63f},
                    {0.40f, 0.66f},   {0.37f, 0.675f, true}, {0.29f, 0.76f},         {0.25f, 0.84f},
                    {0.30f, 0.92f},   {0.42f, 0.965f, true}, {0.43f, 0.98f},         {0.42f, 1}};
        case VesselKind::Plate:
            return {{2.6f, 0, true}, {2.65f, 0.12f}, {3.4f, 0.30f}, {3.9f, 0.55f}, {5.0f, 0.85f}, {6.0f, 1}};
        case VesselKind::Candlestick:
            return {{0.26f, 0, true},     {0.265f, 0.02f},        {0.25f, 0.045f},       {0.20f, 0.06f, true},
                    {0.19f, 0.08f},       {0.08f, 0.11f},         {0.045f, 0.18f},       {0.05f, 0.22f, true},
                    {0.085f, 0.25f},      {0.085f, 0.28f},        {0.05f, 0.31f, true},  {0.035f, 0.36f},
                    {0.06f, 0.52f},       {0.075f, 0.60f},        {0.045f, 0.70f},       {0.03f, 0.76f, true},
                    {0.06f, 0.78f},       {0.06f, 0.80f},         {0.035f, 0.82f, true}, {0.05f, 0.86f},
                    {0.15f, 0.90f, true}, {0.155f, 0.915f, true}, {0.06f, 0.925f, true}, {0.062f, 1}};
        case VesselKind::Cup:
            return {{0.30f, 0, true}, {0.31f, 0.03f}, {0.29f, 0.07f, true}, {0.42f, 0.18f}, {0.49f, 0.45f},
                    {0.50f, 0.75f},   {0.52f, 1}};
        case VesselKind::Pot:
            return {{0.33f, 0, true},     {0.35f, 0.03f}, {0.40f, 0.45f}, {0.46f, 0.82f, true},
                    {0.51f, 0.83f, true}, {0.52f, 0.97f}, {0.51f, 1}};
    }
    return {};
}

/// The inner wall for a contour: its points from the rim down, moved inwards by `wall`, ending on the axis.
/// `from` is the height where the hollow begins.
Profile hollow(const Profile& outer, float wall, float from) {
    Profile inner;
    for (size_t i = outer.size(); i-- > 1;) {
        const Vec2 a(outer[i - 1].radius, outer[i - 1].height),
            b(outer[std::min(i + 1, outer.size() - 1)].radius, outer[std::min(i + 1, outer.size() - 1)].height);
        const Vec2 d = glm::normalize(b - a + Vec2(0, 1e-6f)), inwards(-d.y, d.x);
        const Vec2 p = Vec2(outer[i].radius, outer[i].height) + wall * inwards;
        if (p.y <= from || p.x <= wall * 0.5f) break;
        if (!inner.empty() && p.y >= inner.back().height) continue;
        inner.push_back({p.x, i + 1 == outer.size() ? outer[i].height : p.y, false});
    }
    const ProfilePoint floor = inner.back();
    inner.push_back({floor.radius * 0.6f, from + (floor.height - from) * 0.25f, false});
    inner.push_back({0, from, false});
    return inner;
}

/// Turned ware with a wall of even thickness: closed solids, so that they may be of glass.
class Vessel final : public Procedural {
public:
    void describe(ParameterVisitor& v) override {
        v.choice("kind", kind_,
                 {.label = "Kind",
                  .options = {"vase", "bottle", "bowl", "urn", "plate", "candlestick", "cup", "pot"},
                  .help = "The contour that is turned",
                  .redo = Redo::Build});
        describeLength(v, "height", height_, "Height", 0.005, 5, "From the ground to the rim");
        describeLength(v, "wall", wall_, "Wall", 0.0005, 0.1, "Thickness of the wall");
        v.number("girth", girth_,
                 {.label = "Girth", .min = 0.2, .max = 4, .help = "Factor on every radius", .redo = Redo::Build});
        describeCount(v, "flutes", flutes_, "Flutes", 0, 64, "Ribs around the body; 0 leaves it smooth");
        describeCount(v, "segments", segments_, "Segments", 12, 256, "Facets around");
    }

    ProceduralResult build() const override {
        Profile outer = outerContour(kind_);
        for (ProfilePoint& p : outer) p.radius *= height_ * girth_, p.height *= height_;
        const float rim = outer.back().radius;
        const float base = hollowFrom() * height_;
        Profile all = {{0, 0}};
        all.insert(all.end(), outer.begin(), outer.end());
        const Profile inner = hollow(outer, wall_, base);
        all.push_back({rim - wall_ * 0.5f, height_ + wall_ * 0.35f, false});
        all.insert(all.end(), inner.begin(), inner.end());
        all[1].sharp = true;
        Mesh mesh = lathe(smoothProfile(all, 4), segments_);
        if (flutes_ > 0) {
            deform(
                mesh,
                [&](const Vec3& p) {
                    const float angle = std::atan2(p.z, p.x), up = p.y / height_;
                    const float fade = glm::smoothstep(0.1f, 0.3f, up) * (1 - glm::smoothstep(0.75f, 0.95f, up));
                    const float rib = 1 + 0.035f * fade * std::cos(angle * static_cast<float>(flutes_));
                    return Vec3(p.x * rib, p.y, p.z * rib);
                },
                40);
        }
        return onePart(std::move(mesh), {opaqueSlot("surface", {0.7f, 0.68f, 0.64f}, 0.3f)});
    }

private:
    /// Height of the hollow's floor as a share of the whole.
    float hollowFrom() const {
        constexpr std::array<float, 8> kFrom = {0.05f, 0.05f, 0.14f, 0.30f, 0.30f, 0.935f, 0.12f, 0.06f};
        return kFrom[static_cast<size_t>(kind_)];
    }

    VesselKind kind_ = VesselKind::Vase;
    float height_ = 0.3f, wall_ = 0.004f, girth_ = 1;
    int flutes_ = 0, segments_ = 72;
};

}  // namespace

std::unique_ptr<Procedural> makeVessel() { return std::make_unique<Vessel>(); }

}  // namespace lumi
