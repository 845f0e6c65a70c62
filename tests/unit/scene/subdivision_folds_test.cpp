// Folds: cage vertices between only two faces, where OpenSubdiv 3.5 must be steered around its own faults.
#include "scene/subdivision_folds.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "scene/obj/cage.h"
#include "scene/subdivision_refine.h"
#include "support/refined_cage.h"

namespace lumi::test {
namespace {

/// Two hexagons that share three edges: two folds and a boundary around. With the semi-sharp crease from boundary to
/// boundary, building its patches directly reads out of bounds in OpenSubdiv 3.5.
const char* kHexagons =
    "v -2 0 -1\nv 0 0 -1\nv 0 0.5 0\nv 2 0 -1\nv -2 0 1\nv 0 0 1\nv 0 0.5 0.4\nv 2 0 1\n"
    "f 1 2 3 7 6 5\nf 8 6 7 3 2 4\n#t interpolateboundary 1/0/0 1\n";
const char* kSemiSharp = "#t crease 2/1/0 1 2 5.0\n#t crease 2/1/0 2 6 5.0\n#t crease 2/1/0 6 5 5.0\n";
const char* kDart = "#t crease 2/1/0 1 2 10.0\n";

std::vector<Vec3> limitPoints(const SubdivisionCage& cage, int levels) {
    std::vector<CagePoint> limit;
    refined(cage, levels, &limit);
    std::vector<Vec3> result;
    for (const CagePoint& point : limit) result.push_back(point.p);
    return result;
}

float worstDistance(const SubdivisionSurface& surface, const std::vector<Vec3>& cloud) {
    float worst = 0;
    for (const Vec3& p : surface.mesh.positions) {
        float nearest = kInfinity;
        for (const Vec3& q : cloud) nearest = std::min(nearest, glm::distance(p, q));
        worst = std::max(worst, nearest);
    }
    return worst;
}

TEST(SubdivisionFolds, AreFoundAndOnlyThem) {
    const char* strip = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nf 1 2 3 4\nf 2 5 6 3\n";
    const SubdivisionCage quads = cageOf(strip, "quads");
    EXPECT_FALSE(hasFolds(makeRefiner(quads, "test")->GetLevel(0)));
    EXPECT_TRUE(hasFolds(makeRefiner(cageOf(kHexagons, "hexagons"), "test")->GetLevel(0)));
    // Two faces back to back: every vertex is a fold.
    const SubdivisionCage pillow = cageOf("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nf 4 3 2 1\n", "pillow");
    EXPECT_TRUE(hasFolds(makeRefiner(pillow, "test")->GetLevel(0)));
}

TEST(SubdivisionFolds, TessellationLiesOnTheLimitOfRefinement) {
    // Refinement uses up the semi-sharp creases, and Bfr's patches around extraordinary points are approximations; the
    // dart's edge differs from an infinitely sharp one by less than a thousandth of its length.
    const std::tuple<const char*, float> cases[] = {{"", 1e-4f}, {kSemiSharp, 1e-4f}, {kDart, 2e-3f}};
    for (const auto& [tags, tolerance] : cases) {
        const SubdivisionCage cage = cageOf(std::string(kHexagons) + tags, "hexagons");
        const SubdivisionSurface surface = tessellate(cage, 4, "hexagons");
        EXPECT_GT(surface.mesh.triangles.size(), 60u);
        EXPECT_LT(worstDistance(surface, limitPoints(cage, 6)), tolerance) << tags;
    }
}

TEST(SubdivisionFolds, OtherFacesAreTessellatedAsWithoutThem) {
    // A prism over a pentagon has no folds. Beside the hexagons it goes through the refined cage, and must come out at
    // the same (face, u, v) with the same positions and texture coordinates, and normals that differ by no more than
    // Bfr's approximation at extraordinary points does from one level to the next.
    std::string prism;
    for (int ring = 0; ring < 2; ++ring)
        for (int i = 0; i < 5; ++i)
            prism += fmt::format("v {} {} {}\n", std::cos(1.2566f * float(i)), ring, std::sin(1.2566f * float(i)));
    prism += "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 0.5 0.5\nf 5/1 4/2 3/3 2/4 1/5\nf 6/1 7/2 8/3 9/4 10/5\n";
    for (int i = 0; i < 5; ++i)
        prism += fmt::format("f {}/1 {}/2 {}/3 {}/4\n", i + 1, (i + 1) % 5 + 1, (i + 1) % 5 + 6, i + 6);
    std::string both = prism + "v 12 0 -1\nv 15 0 -1\nv 15 0.5 0\nv 18 0 -1\n";
    both += "v 12 0 1\nv 15 0 1\nv 15 0.5 0.4\nv 18 0 1\n";
    both += "f 11/1 12/2 13/3 17/4 16/5 15/1\nf 18/1 16/2 17/3 13/4 12/5 14/1\n";

    const SubdivisionSurface alone = tessellate(cageOf(prism, "prism"), 4, "prism");
    const SubdivisionSurface beside = tessellate(cageOf(both, "both"), 4, "both");
    const auto key = [](const SubdivisionSurface& s, size_t t, int corner) {
        const Vec2 uv = s.faceCoordinates[s.mesh.triangles[t][corner]];
        return std::tuple(s.triangleFace[t], std::lround(uv.x * 1000), std::lround(uv.y * 1000));
    };
    std::map<std::tuple<uint32_t, long, long>, uint32_t> vertices;
    for (size_t t = 0; t < beside.mesh.triangles.size(); ++t)
        for (int c = 0; c < 3; ++c) vertices[key(beside, t, c)] = beside.mesh.triangles[t][c];
    size_t compared = 0;
    for (size_t t = 0; t < alone.mesh.triangles.size(); ++t)
        for (int c = 0; c < 3; ++c) {
            const auto found = vertices.find(key(alone, t, c));
            if (found == vertices.end()) continue;
            const uint32_t a = alone.mesh.triangles[t][c], b = found->second;
            EXPECT_LT(glm::distance(alone.mesh.positions[a], beside.mesh.positions[b]), 1e-4f);
            EXPECT_LT(glm::distance(alone.mesh.normals[a], beside.mesh.normals[b]), 1e-2f);
            EXPECT_LT(glm::distance(alone.mesh.uv[0][a], beside.mesh.uv[0][b]), 1e-4f);
            ++compared;
        }
    EXPECT_GT(compared, alone.mesh.triangles.size());
}

/// Two triangles back to back, whose folds have the cage refined, beside faces that go round a vertex twice. Refined
/// once, the middle of that vertex's edge to itself is a fold on open faces with semi-sharp edges about them: the other
/// edges of the first quad are boundaries, those of the twin pentagons have two faces in the same direction, and those
/// of the last quads are open in their texture coordinates alone.
const std::string kPillow = "v 9 0 0\nv 10 0 0\nv 9 1 0\nf 1 2 3\nf 2 1 3\n";
const std::string kDoubled[] = {
    kPillow + "v 0 0 0\nv 1 0 0\nv 1 1 0.3\nv -0.5 1 0\nv 0.5 -1 0\nf 4 4 5 6\nf 4 7 8 5\n#t crease 2/1/0 4 3 2.0\n",
    kPillow + "v 0 0 0\nv 1 0 0\nv 1 1 0.3\nv 0 1 0\nf 4 5 6 7 7\nf 4 5 6 7 7\n",
    "v 0 0 0\nv 1 0 0\nv 1 1 0.3\nvt 0 0\nvt 1 1\nf 3/2 1/1 1/2 2/1\nf 1/2 3/2 2/1 1/2\n"
    "#t facevaryinginterpolateboundary 1/0/0 3\n"};

/// Two cones of triangles, base to base, all of whose edges are semi-sharp.
std::string creasedCones(int sides) {
    std::string vertices = "v 0 0 1\nv 0 0 -1\n", faces, creases;
    for (int i = 0; i < sides; ++i) {
        const float angle = 2 * kPi * float(i) / float(sides);
        const int here = 2 + i, next = 2 + (i + 1) % sides;
        vertices += fmt::format("v {} {} 0\n", std::cos(angle), std::sin(angle));
        faces += fmt::format("f 1 {} {}\nf 2 {} {}\n", here + 1, next + 1, next + 1, here + 1);
        for (const int end : {0, 1, next}) creases += fmt::format("#t crease 2/1/0 {} {} 2.0\n", here, end);
    }
    return vertices + faces + creases;
}

TEST(SubdivisionFolds, OfAFaceThatHasAVertexTwice) {
    for (const std::string& text : kDoubled) {
        const SubdivisionCage cage = cageOf(text, "doubled");
        const RefinedCage once = refineOnce(cage, "test"), twice = refineOnce(once.cage, "test");
        EXPECT_TRUE(hasOpenFolds(makeRefiner(once.cage, "test")->GetLevel(0)));
        EXPECT_FALSE(hasOpenFolds(makeRefiner(twice.cage, "test")->GetLevel(0)));
        const SubdivisionSurface surface = tessellate(cage, 4, "doubled");
        EXPECT_LT(worstDistance(surface, limitPoints(cage, 7)), 2e-3f);
        // What OpenSubdiv read there was whatever lay in memory: once would not be enough.
        for (int round = 0; round < 20; ++round)
            EXPECT_EQ(tessellate(cage, 4, "doubled").mesh.positions, surface.mesh.positions);
    }
}

TEST(SubdivisionFolds, CreasesBetweenManyTriangles) {
    EXPECT_FALSE(hasCrowdedCreases(makeRefiner(cageOf(creasedCones(20), "few"), "test")->GetLevel(0)));
    for (const int sides : {40, 200}) {
        const SubdivisionCage cage = cageOf(creasedCones(sides), "cones");
        EXPECT_TRUE(hasCrowdedCreases(makeRefiner(cage, "test")->GetLevel(0)));
        EXPECT_FALSE(hasCrowdedCreases(makeRefiner(refineOnce(cage, "test").cage, "test")->GetLevel(0)));
        EXPECT_LT(worstDistance(tessellate(cage, 2, "cones"), limitPoints(cage, 3)), 1e-4f);
    }
}

}  // namespace
}  // namespace lumi::test
