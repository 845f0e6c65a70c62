#include <map>
#include <string>

#include "scene/procedural/generators.h"
#include "scene/procedural/hall_parts.h"

namespace lumi {
namespace {

using namespace hall;

/// Places instances of a few meshes, each with a node of its own.
class Placer {
public:
    explicit Placer(ProceduralResult& result) : result_(result) {}

    static std::shared_ptr<const Mesh> share(Mesh mesh) {
        tidy(mesh);
        return std::make_shared<const Mesh>(std::move(mesh));
    }
    void put(const std::string& name, const std::shared_ptr<const Mesh>& mesh, const Vec3& at, float yawDeg = 0) {
        Node node;
        node.name = name + "-" + std::to_string(++counts_[name]);
        node.local.translation = at;
        node.local.rotation = glm::angleAxis(radians(yawDeg), Vec3(0, 1, 0));
        ProceduralPart part;
        part.name = node.name;
        part.mesh = mesh;
        part.node = static_cast<int>(result_.nodes.size());
        result_.nodes.push_back(std::move(node));
        result_.parts.push_back(std::move(part));
    }

private:
    ProceduralResult& result_;
    std::map<std::string, int> counts_;
};

/// A court open to the sky with a vaulted gallery one bay deep around it on each floor: arcades on columns towards the
/// court, blind arches with doors or open windows in the outer walls, balustrades above. The court's floor is on y = 0;
/// bays run along X and Z about the origin.
class Hall final : public Procedural {
public:
    void describe(ParameterVisitor& v) override {
        describeCount(v, "bays-x", baysX_, "Bays along X", 1, 40, "Of the court, without the galleries");
        describeCount(v, "bays-z", baysZ_, "Bays along Z", 1, 40, "Of the court, without the galleries");
        describeCount(v, "floors", floors_, "Floors", 1, 6, "Of arches above each other");
        describeLength(v, "bay", bay_, "Bay", 1.5, 10, "From column to column");
        describeLength(v, "column-height", columnHeight_, "Column height", 1, 10, "On the ground floor");
        describeLength(v, "column-radius", columnRadius_, "Column radius", 0.08, 1, "At the foot of the shaft");
        describeCount(v, "flutes", flutes_, "Flutes", 0, 32, "Grooves of the shafts; 0 leaves them round");
        v.toggle("lanterns", lanterns_,
                 {.label = "Lanterns", .help = "A lantern under every second vault", .redo = Redo::Build});
    }

    ProceduralResult build() const override {
        ProceduralResult result;
        result.slots = slots();
        Placer placer(result);
        addGround(result);
        float y = kStep;
        for (int floor = 0; floor < floors_; ++floor) y += addFloor(placer, floor, y);
        addRoof(result, placer, y);
        return result;
    }

private:
    static constexpr float kStep = 0.16f;       ///< galleries lie one step above the court
    static constexpr float kThickness = 0.46f;  ///< of the arcade walls
    static constexpr float kReveal = 0.34f;     ///< how far floors reach into the outer walls
    static constexpr float kOverArch = 0.62f;   ///< wall above the crown, up to the next floor

    static std::vector<MaterialSlot> slots() {
        MaterialSlot flame = opaqueSlot("flame", {1, 1, 1}, 1);
        flame.fallback.emission = {30, 16, 6};
        return {opaqueSlot("stone", {0.56f, 0.48f, 0.38f}, 0.85f),
                opaqueSlot("trim", {0.64f, 0.57f, 0.47f}, 0.75f),
                opaqueSlot("floor", {0.45f, 0.40f, 0.34f}, 0.35f),
                opaqueSlot("vault", {0.62f, 0.54f, 0.43f}, 0.9f),
                opaqueSlot("columns", {0.62f, 0.55f, 0.46f}, 0.6f),
                opaqueSlot("roof", {0.42f, 0.16f, 0.08f}, 0.9f),
                opaqueSlot("wood", {0.18f, 0.09f, 0.045f}, 0.6f),
                opaqueSlot("metal", {0.10f, 0.09f, 0.08f}, 0.45f, 1),
                flame};
    }

    float archRadius() const { return bay_ / 2 - columnRadius_ * 1.37f; }
    float columnHeightOn(int floor) const { return floor == 0 ? columnHeight_ : columnHeight_ * 0.80f; }
    float floorHeight(int floor) const { return columnHeightOn(floor) + archRadius() + kOverArch; }
    float halfX() const { return bay_ * static_cast<float>(baysX_) / 2; }
    float halfZ() const { return bay_ * static_cast<float>(baysZ_) / 2; }

    void addGround(ProceduralResult& result) const {
        Mesh mesh;
        const float x = halfX(), z = halfZ(), X = x + bay_, Z = z + bay_, in = kThickness * 0.75f;
        append(mesh, flatPatch({-x, 0, z}, {2 * x, 0, 0}, {0, 0, -2 * z}), kFloor);
        addRing(mesh, x - in, z - in, X + kReveal, Z + kReveal, kStep, kFloor);
        // The step up to the galleries, with a rounded nosing.
        for (int side = 0; side < 4; ++side) {
            const float length = side % 2 == 0 ? 2 * (x - in) : 2 * (z - in), reach = side % 2 == 0 ? z - in : x - in;
            const Mat4 place = placed({0, 0, 0}, {0, 90.0f * static_cast<float>(side), 0});
            append(mesh, flatPatch({length / 2, 0, reach}, {-length, 0, 0}, {0, kStep - 0.04f, 0}), kTrim, place);
            append(mesh, roundedBox({length + 0.06f, 0.05f, 0.30f}, 0.02f, 3), kTrim,
                   place * placed({0, kStep - 0.024f, reach + 0.12f}));
        }
        addPart(result, "ground", std::move(mesh));
    }

    /// The flat ring between an inner and an outer rectangle, seen from above.
    static void addRing(Mesh& mesh, float x, float z, float X, float Z, float y, uint32_t slot) {
        append(mesh, flatPatch({-X, y, Z}, {2 * X, 0, 0}, {0, 0, z - Z}), slot);
        append(mesh, flatPatch({-X, y, -z}, {2 * X, 0, 0}, {0, 0, z - Z}), slot);
        append(mesh, flatPatch({-X, y, z}, {X - x, 0, 0}, {0, 0, -2 * z}), slot);
        append(mesh, flatPatch({x, y, z}, {X - x, 0, 0}, {0, 0, -2 * z}), slot);
    }

    /// Returns the floor's height.
    float addFloor(Placer& placer, int floor, float y) const {
        const float tall = columnHeightOn(floor), r = archRadius(), whole = floorHeight(floor);
        const auto column = Placer::share(hall::column(tall, columnRadius_ * (floor == 0 ? 1 : 0.88f), flutes_));
        const auto pier = Placer::share(hall::pier(tall, columnRadius_ * 2.9f));
        const auto arch = Placer::share(archPanel(bay_, r + kOverArch, kThickness, 0.02f, r, true));
        const auto rail = floor > 0 ? Placer::share(balustrade(bay_ - columnRadius_ * 2.4f, 0.95f, 0.52f)) : nullptr;
        forCourtEdge(
            [&](const Vec3& at, float yaw, bool corner) {
                placer.put(corner ? "pier" : "column", corner ? pier : column, at + Vec3(0, y, 0), yaw);
            },
            [&](const Vec3& at, float yaw) {
                placer.put("arch", arch, at + Vec3(0, y + tall, 0), yaw);
                if (rail) placer.put("balustrade", rail, at + Vec3(0, y, 0), yaw);
            });
        addVaults(placer, floor, y + tall);
        addOuterWalls(placer, floor, y, whole);
        addSlab(placer, y + whole);
        return whole;
    }

    /// Calls `support` at every lattice point of the court's edge and `span` between them; yaw turns +Z to the court.
    template <class Support, class Span>
    void forCourtEdge(const Support& support, const Span& span) const {
        const float x = halfX(), z = halfZ();
        for (int i = 0; i <= baysX_; ++i)
            for (const float side : {-1.0f, 1.0f}) {
                const float at = -x + bay_ * static_cast<float>(i);
                support(Vec3(at, 0, side * z), side < 0 ? 0.0f : 180.0f, i == 0 || i == baysX_);
                if (i < baysX_) span(Vec3(at + bay_ / 2, 0, side * z), side < 0 ? 0.0f : 180.0f);
            }
        for (int i = 0; i < baysZ_; ++i)
            for (const float side : {-1.0f, 1.0f}) {
                const float at = -z + bay_ * static_cast<float>(i);
                if (i > 0) support(Vec3(side * x, 0, at), side < 0 ? 90.0f : -90.0f, false);
                span(Vec3(side * x, 0, at + bay_ / 2), side < 0 ? 90.0f : -90.0f);
            }
    }

    void addVaults(Placer& placer, int floor, float y) const {
        const auto vault = Placer::share(groinVault(bay_, bay_, archRadius() + 0.2f, 0.24f));
        const auto light = lanterns_ ? Placer::share(lantern(0.9f, 0.26f)) : nullptr;
        for (int i = -1; i <= baysX_; ++i)
            for (int k = -1; k <= baysZ_; ++k) {
                const bool gallery = i < 0 || k < 0 || i == baysX_ || k == baysZ_;
                if (!gallery) continue;
                const Vec3 at(-halfX() + bay_ * (static_cast<float>(i) + 0.5f), y,
                              -halfZ() + bay_ * (static_cast<float>(k) + 0.5f));
                placer.put("vault", vault, at);
                if (light && floor == 0 && (i + k) % 2 == 0)
                    placer.put("lantern", light, at + Vec3(0, archRadius() + 0.08f, 0));
            }
    }

    /// The half pier in the outer wall from which the vaults spring.
    static Mesh respond(float height, float width) {
        Mesh mesh;
        append(mesh, roundedBox({width, height, width * 0.8f}, 0.02f, 1), kStone, placed({0, height / 2, 0}));
        append(mesh, roundedBox({width * 1.2f, 0.24f, width}, 0.015f, 1), kTrim, placed({0, 0.12f, 0}));
        append(mesh, roundedBox({width * 1.24f, 0.13f, width * 1.1f}, 0.015f, 1), kTrim,
               placed({0, height - 0.065f, 0}));
        return mesh;
    }

    void addOuterWalls(Placer& placer, int floor, float y, float whole) const {
        const float r = bay_ * 0.23f, spring = floor == 0 ? 1.75f : 1.35f, thick = 0.4f,
                    bottom = floor == 0 ? 0 : 0.85f;
        Mesh panel = archPanel(bay_, whole - bottom, thick, spring, r, false);
        if (bottom > 0) {
            deform(
                panel, [&](const Vec3& p) { return p + Vec3(0, bottom, 0); }, 35);
            append(panel, flatPatch({-bay_ / 2, 0, thick / 2}, {bay_, 0, 0}, {0, bottom, 0}), kStone);
            append(panel, flatPatch({bay_ / 2, 0, -thick / 2}, {-bay_, 0, 0}, {0, bottom, 0}), kStone);
            append(panel, roundedBox({2 * r + 0.24f, 0.09f, thick + 0.16f}, 0.02f, 1), kTrim,
                   placed({0, bottom, 0.03f}));
        }
        append(panel, respond(columnHeightOn(floor), columnRadius_ * 2.2f), 0, placed({-bay_ / 2, 0, thick * 0.42f}));
        Mesh closed = panel;
        if (floor == 0) {
            append(closed, archDoor(spring, r), 0, placed({0, 0, -0.04f}));
            append(panel, flatPatch({-r, 0, -0.10f}, {2 * r, 0, 0}, {0, spring + r, 0}), kStone);
        }
        const auto open = Placer::share(std::move(panel)), door = Placer::share(std::move(closed));
        const float X = halfX() + bay_ + thick * 0.4f, Z = halfZ() + bay_ + thick * 0.4f;
        for (int i = -1; i <= baysX_; ++i) {
            const float at = -halfX() + bay_ * (static_cast<float>(i) + 0.5f);
            const auto& mesh = i % 2 == 0 ? door : open;
            placer.put("wall", mesh, {at, y, -Z}, 0);
            placer.put("wall", mesh, {at, y, Z}, 180);
        }
        for (int i = -1; i <= baysZ_; ++i) {
            const float at = -halfZ() + bay_ * (static_cast<float>(i) + 0.5f);
            const auto& mesh = i % 2 == 0 ? open : door;
            placer.put("wall", mesh, {-X, y, at}, 90);
            placer.put("wall", mesh, {X, y, at}, -90);
        }
    }

    /// The floor above: a flat ring over the vaults and a string course along the arcade on the court's side.
    void addSlab(Placer& placer, float y) const {
        Mesh mesh;
        const float x = halfX(), z = halfZ(), in = kThickness / 2 + 0.02f;
        addRing(mesh, x - in, z - in, x + bay_ + kReveal, z + bay_ + kReveal, y, kFloor);
        for (int side = 0; side < 4; ++side) {
            const float length = side % 2 == 0 ? 2 * (x - in) : 2 * (z - in), reach = side % 2 == 0 ? z - in : x - in;
            append(mesh, cornice(length, 0.26f, 0.16f, false), 0,
                   placed({0, y, 0}, {0, 90.0f * static_cast<float>(side), 0}) * placed({0, 0, -reach}));
        }
        placer.put("slab", Placer::share(std::move(mesh)), Vec3(0));
    }

    void addRoof(ProceduralResult& result, Placer& placer, float y) const {
        Mesh mesh;
        const float x = halfX(), z = halfZ(), in = kThickness / 2 - 0.02f;
        for (int side = 0; side < 4; ++side) {
            const float length = side % 2 == 0 ? 2 * (x - in) : 2 * (z - in), reach = side % 2 == 0 ? z - in : x - in;
            const Mat4 turn = placed({0, 0, 0}, {0, 90.0f * static_cast<float>(side), 0});
            append(mesh, cornice(length, 0.62f, 0.42f, true), 0, turn * placed({0, y + 0.52f, -reach}));
            append(mesh,
                   flatPatch({-length / 2 - 1, y + 0.5f, -reach + 0.3f}, {length + 2, 0, 0},
                             {0, 1.1f, -bay_ * 0.5f - 0.8f}),
                   kRoof, turn);
        }
        // Outer walls end in a plain parapet that hides the roof's back.
        for (int side = 0; side < 4; ++side) {
            const float length = 2 * ((side % 2 == 0 ? x : z) + bay_ + 0.4f),
                        reach = (side % 2 == 0 ? z : x) + bay_ + 0.2f;
            append(mesh, roundedBox({length, 0.9f, 0.42f}, 0.02f, 1), kStone,
                   placed({0, y + 0.4f, 0}, {0, 90.0f * static_cast<float>(side), 0}) * placed({0, 0, -reach}));
        }
        addPart(result, "roof", std::move(mesh));
        const float tile = 0.21f;
        const auto row = Placer::share(tileRow(bay_ * 0.5f + 0.8f, 1.1f));
        for (int side = 0; side < 4; ++side) {
            const float length = side % 2 == 0 ? 2 * (x - in) : 2 * (z - in), reach = side % 2 == 0 ? z - in : x - in;
            const int count = static_cast<int>(length / tile);
            const float yaw = 90.0f * static_cast<float>(side);
            for (int i = 0; i < count; ++i) {
                const Vec3 local(length * ((static_cast<float>(i) + 0.5f) / static_cast<float>(count) - 0.5f), y + 0.5f,
                                 -reach + 0.32f);
                placer.put("tiles", row, transformPoint(placed({0, 0, 0}, {0, yaw, 0}), local), yaw);
            }
        }
    }

    /// One row of half-round tiles from the eaves (origin) up and back by `run` and `rise`.
    static Mesh tileRow(float run, float rise) {
        Mesh mesh;
        const int tiles = 3;
        for (int i = 0; i < tiles; ++i) {
            const float t0 = static_cast<float>(i) / tiles, t1 = static_cast<float>(i + 1) / tiles + 0.03f;
            Mesh tile = gridSurface(4, 1, [&](float u, float v) {
                const float t = glm::mix(t0, t1, v), r = 0.085f - 0.018f * v, a = kPi * u;
                return Vec3(r * std::cos(a), rise * t + r * std::sin(a) * 0.8f + 0.02f * (1 - v), -run * t);
            });
            append(mesh, tile, kRoof);
        }
        return mesh;
    }

    int baysX_ = 5, baysZ_ = 2, floors_ = 2, flutes_ = 0;
    float bay_ = 3.6f, columnHeight_ = 3.1f, columnRadius_ = 0.235f;
    bool lanterns_ = false;
};

}  // namespace

std::unique_ptr<Procedural> makeHall() { return std::make_unique<Hall>(); }

}  // namespace lumi
