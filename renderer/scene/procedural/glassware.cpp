#include <algorithm>

#include "scene/procedural/generators.h"

namespace lumi {
namespace {

enum class GlassKind { Wine, Tumbler, Flute };

/// Radius of a contour at a height, along its rising or falling polyline.
float radiusAt(const Profile& contour, float height) {
    for (size_t i = 1; i < contour.size(); ++i) {
        const auto [low, high] = std::minmax(contour[i - 1].height, contour[i].height);
        if (height < low || height > high || high == low) continue;
        const float t = (height - contour[i - 1].height) / (contour[i].height - contour[i - 1].height);
        return glm::mix(contour[i - 1].radius, contour[i].radius, t);
    }
    return 0;
}

/// A liquid's closed surface inside the hollow `inner` (smooth contour from the rim down to the axis), filled to
/// `level`; it keeps `gap` from the wall and creeps up a little where it meets it.
Mesh liquid(const Profile& inner, float level, float gap, int segments) {
    Profile body = {{0, inner.back().height + gap}};
    for (size_t i = inner.size() - 1; i-- > 0;) {
        if (inner[i].height >= level - 0.0008f) break;
        if (inner[i].height <= body.back().height || inner[i].radius <= gap) continue;
        body.push_back({inner[i].radius - gap, inner[i].height + gap * 0.3f});
    }
    const float edge = radiusAt(inner, level) - gap;
    body.push_back({edge, level + 0.0010f, true});
    body.push_back({edge - 0.0008f, level + 0.0004f});
    body.push_back({edge - 0.0025f, level});
    body.push_back({edge * 0.6f, level, true});
    body.push_back({0, level});
    return lathe(body, segments);
}

/// A stemmed or straight glass with an optional filling, both closed solids.
class DrinkingGlass final : public Procedural {
public:
    void describe(ParameterVisitor& v) override {
        v.choice("kind", kind_,
                 {.label = "Kind",
                  .options = {"wine", "tumbler", "flute"},
                  .help = "The form of the glass",
                  .redo = Redo::Build});
        describeLength(v, "height", height_, "Height", 0.03, 1, "From the foot to the rim");
        describeLength(v, "wall", wall_, "Wall", 0.0003, 0.02, "Thickness at the rim");
        v.number(
            "fill", fill_,
            {.label = "Fill", .min = 0, .max = 0.95, .help = "Share of the bowl's height filled", .redo = Redo::Build});
        describeCount(v, "segments", segments_, "Segments", 12, 256, "Facets around");
    }

    ProceduralResult build() const override {
        Profile outer, inner;
        contours(outer, inner);
        for (Profile* p : {&outer, &inner})
            for (ProfilePoint& q : *p) q.radius *= height_, q.height *= height_;
        for (ProfilePoint& q : inner)
            if (q.radius > 0) q.radius -= wall_;
        outer.back().radius -= wall_ * 0.1f;
        Profile all = {{0, 0}};
        all.insert(all.end(), outer.begin(), outer.end());
        all.push_back({outer.back().radius - wall_ * 0.45f, height_ + wall_ * 0.45f, false});
        all.insert(all.end(), inner.begin(), inner.end());
        ProceduralResult result =
            onePart(lathe(smoothProfile(all, 5), segments_),
                    {glassSlot("glass"), glassSlot("liquid", {0.42f, 0.012f, 0.02f}, 0.012f, 1.345f)});
        result.parts[0].name = "glass";
        if (fill_ > 0) {
            const Profile hollow = smoothProfile(inner, 5);
            const float floor = hollow.back().height, level = floor + (height_ - floor) * fill_;
            Mesh wine = liquid(hollow, level, 0.0002f, segments_);
            wine.material = 1;
            addPart(result, "liquid", std::move(wine));
        }
        return result;
    }

private:
    /// For a height of 1; the inner contour is the outer one's and loses the wall's thickness afterwards.
    void contours(Profile& outer, Profile& inner) const {
        switch (kind_) {
            case GlassKind::Wine:
                outer = {{0.165f, 0, true}, {0.172f, 0.004f}, {0.168f, 0.010f}, {0.10f, 0.022f},  {0.035f, 0.045f},
                         {0.0195f, 0.09f},  {0.0175f, 0.25f}, {0.021f, 0.40f},  {0.045f, 0.455f}, {0.125f, 0.53f},
                         {0.190f, 0.65f},   {0.196f, 0.75f},  {0.172f, 0.89f},  {0.150f, 1}};
                inner = {{0.150f, 0.995f}, {0.172f, 0.89f},  {0.196f, 0.75f}, {0.190f, 0.65f},
                         {0.125f, 0.535f}, {0.055f, 0.480f}, {0, 0.468f}};
                break;
            case GlassKind::Tumbler:
                outer = {{0.33f, 0, true}, {0.35f, 0.01f}, {0.36f, 0.04f}, {0.40f, 0.5f}, {0.42f, 1}};
                inner = {{0.42f, 0.995f}, {0.40f, 0.5f}, {0.37f, 0.18f}, {0.34f, 0.13f}, {0, 0.12f}};
                break;
            case GlassKind::Flute:
                outer = {{0.14f, 0, true}, {0.146f, 0.004f}, {0.14f, 0.01f},  {0.07f, 0.024f}, {0.022f, 0.05f},
                         {0.014f, 0.1f},   {0.013f, 0.26f},  {0.018f, 0.34f}, {0.05f, 0.40f},  {0.095f, 0.55f},
                         {0.105f, 0.70f},  {0.095f, 0.9f},   {0.088f, 1}};
                inner = {{0.088f, 0.995f}, {0.095f, 0.9f},  {0.105f, 0.70f}, {0.095f, 0.55f},
                         {0.052f, 0.415f}, {0.02f, 0.375f}, {0, 0.37f}};
                break;
        }
    }

    GlassKind kind_ = GlassKind::Wine;
    float height_ = 0.22f, wall_ = 0.0012f, fill_ = 0.35f;
    int segments_ = 96;
};

/// A wine bottle: glass, wine inside, cork or foil at the neck, a paper label around the front (+Z).
class WineBottle final : public Procedural {
public:
    void describe(ParameterVisitor& v) override {
        describeLength(v, "height", height_, "Height", 0.1, 1, "Over the cork");
        v.number("fill", fill_,
                 {.label = "Fill", .min = 0, .max = 0.9, .help = "Share of the height filled", .redo = Redo::Build});
        v.toggle("label", label_, {.label = "Label", .help = "A paper label on the front", .redo = Redo::Build});
        describeCount(v, "segments", segments_, "Segments", 12, 256, "Facets around");
    }

    ProceduralResult build() const override {
        const float h = height_, wall = 0.0030f;
        Profile outer = {{0.090f, 0.012f},        {0.116f, 0, true}, {0.122f, 0.010f},       {0.124f, 0.05f},
                         {0.124f, 0.35f},         {0.1235f, 0.56f},  {0.112f, 0.64f},        {0.075f, 0.71f},
                         {0.051f, 0.77f},         {0.047f, 0.83f},   {0.0455f, 0.93f, true}, {0.0505f, 0.935f},
                         {0.0505f, 0.955f, true}, {0.0465f, 0.96f},  {0.0455f, 0.985f}};
        for (ProfilePoint& p : outer) p.radius *= h, p.height *= h;
        Profile inner = {{0.0455f, 0.98f}, {0.0455f, 0.93f}, {0.047f, 0.83f},   {0.051f, 0.77f},
                         {0.075f, 0.705f}, {0.112f, 0.632f}, {0.1235f, 0.555f}, {0.124f, 0.35f},
                         {0.124f, 0.07f},  {0.110f, 0.035f}, {0.05f, 0.045f},   {0, 0.055f}};
        for (ProfilePoint& p : inner)
            p.radius = std::max(0.0f, p.radius * h - (p.radius > 0 ? wall : 0)), p.height *= h;
        Profile all = {{0, 0.035f * h}, {0.04f * h, 0.028f * h}};
        all.insert(all.end(), outer.begin(), outer.end());
        all.push_back({0.0455f * h - wall * 0.5f, 0.988f * h, false});
        all.insert(all.end(), inner.begin(), inner.end());
        ProceduralResult result = onePart(
            lathe(smoothProfile(all, 4), segments_),
            {glassSlot("glass", {0.10f, 0.30f, 0.08f}, 0.004f, 1.52f),
             glassSlot("liquid", {0.35f, 0.01f, 0.02f}, 0.012f, 1.345f),
             opaqueSlot("cork", {0.48f, 0.31f, 0.17f}, 0.9f), opaqueSlot("label", {0.80f, 0.75f, 0.62f}, 0.8f)});
        result.parts[0].name = "glass";
        const Profile hollow = smoothProfile(inner, 4);
        if (fill_ > 0) {
            // The floor rises in the middle, so the liquid rests on a plane just above it.
            Profile cavity;
            for (const ProfilePoint& p : hollow)
                if (p.height > 0.058f * h) cavity.push_back(p);
            cavity.push_back({0, 0.0575f * h});
            Mesh wine = liquid(cavity, fill_ * h, 0.0002f, segments_);
            wine.material = 1;
            addPart(result, "liquid", std::move(wine));
        }
        addCork(result, h, wall);
        if (label_) addLabel(result, h);
        return result;
    }

private:
    static void addCork(ProceduralResult& result, float h, float wall) {
        const float r = 0.0455f * h - wall - 0.0001f, top = h;
        Mesh cork = lathe(smoothProfile({{0, 0.90f * h},
                                         {r, 0.90f * h, true},
                                         {r, 0.987f * h, true},
                                         {r + 0.0012f, 0.990f * h},
                                         {r + 0.0012f, top - 0.002f},
                                         {r, top},
                                         {r - 0.002f, top + 0.0004f},
                                         {0, top + 0.0004f}},
                                        4),
                          40);
        cork.material = 2;
        addPart(result, "cork", std::move(cork));
    }

    static void addLabel(ProceduralResult& result, float h) {
        const float r = 0.124f * h + 0.00035f;
        Mesh paper = gridSurface(48, 8, [&](float u, float v) {
            const float a = (u - 0.5f) * 2.5f;
            return Vec3(r * std::sin(a), h * (0.14f + 0.29f * v), r * std::cos(a));
        });
        for (Vec2& uv : paper.uv[0]) uv.y = 1 - uv.y;
        paper.material = 3;
        addPart(result, "label", std::move(paper));
    }

    float height_ = 0.31f, fill_ = 0.5f;
    bool label_ = true;
    int segments_ = 96;
};

}  // namespace

std::unique_ptr<Procedural> makeDrinkingGlass() { return std::make_unique<DrinkingGlass>(); }
std::unique_ptr<Procedural> makeBottle() { return std::make_unique<WineBottle>(); }

}  // namespace lumi
