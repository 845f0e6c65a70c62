// Random cages of few vertices, where faces overlap, fold back, meet three at an edge or go round a vertex twice, under
// random tags: every one tessellates, into vertices that are averages of the cage's. $LUMISCOPE_MUTATIONS sets how
// many.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <random>

#include "scene/subdivision.h"

namespace lumi {
namespace {

using Face = std::vector<uint32_t>;

class RandomCage {
public:
    explicit RandomCage(uint64_t seed) : random_(seed) {}

    SubdivisionCage make() {
        const int vertices = 3 + pick(12), count = 1 + pick(12);
        for (int i = 0; i < vertices; ++i) cage_.positions.emplace_back(coordinate(), coordinate(), coordinate());
        std::vector<Face> faces;
        for (int i = 0; i < count; ++i) {
            faces.push_back(anotherFace(faces));
            if (pick(20) == 0) faces.back().push_back(faces.back().back());
            cage_.faceSizes.push_back(static_cast<uint32_t>(faces.back().size()));
            cage_.faceVertices.insert(cage_.faceVertices.end(), faces.back().begin(), faces.back().end());
        }
        if (pick(3) == 0) addUvs();
        addTags(faces);
        return std::move(cage_);
    }

private:
    int pick(int count) { return static_cast<int>(random_() % static_cast<uint64_t>(count)); }
    float coordinate() { return static_cast<float>(pick(2001) - 1000) / 1000; }
    uint32_t vertex() { return static_cast<uint32_t>(pick(static_cast<int>(cage_.positions.size()))); }

    /// A face of its own, or one that has a face, a corner or an edge in common with an earlier one.
    Face anotherFace(const std::vector<Face>& faces) {
        Face face;
        const int kind = faces.empty() ? 3 : pick(4);
        if (!faces.empty()) face = faces[static_cast<size_t>(pick(static_cast<int>(faces.size())))];
        if (kind > 0) std::rotate(face.begin(), face.begin() + (face.empty() ? 0 : pick(int(face.size()))), face.end());
        if (kind == 3) face.clear();
        if (kind == 0 && pick(5) == 0) face[0] = vertex();
        if (kind == 1 || kind == 2) face.resize(static_cast<size_t>(kind) + 1);
        if (pick(4) > 0) std::reverse(face.begin(), face.end());
        const auto size = static_cast<size_t>(3 + pick(4) % 3 + (pick(8) == 0 ? 2 : 0));
        while (kind > 0 && face.size() < size) {
            const uint32_t next = vertex();
            if (pick(4) == 0 || std::find(face.begin(), face.end(), next) == face.end()) face.push_back(next);
            else if (cage_.positions.size() < size) face.push_back(next);
        }
        return face;
    }
    void addUvs() {
        for (int i = 1 + pick(8); i > 0; --i) cage_.uvs.emplace_back(coordinate(), coordinate());
        const auto count = static_cast<uint32_t>(cage_.uvs.size());
        for (const uint32_t corner : cage_.faceVertices)
            cage_.faceUvs.push_back(pick(5) ? corner % count : static_cast<uint32_t>(pick(static_cast<int>(count))));
    }
    void addTags(const std::vector<Face>& faces) {
        constexpr std::array kSharpness = {0.5f, 1.0f, 2.0f, 3.7f, 9.0f, 9.9f, 10.0f, 12.0f};
        const auto sharpness = [&] { return kSharpness[static_cast<size_t>(pick(8))]; };
        const int density = pick(3);
        for (const Face& face : faces)
            for (size_t i = 0; i < face.size(); ++i)
                if (pick(5) < density) cage_.creases.push_back({face[i], face[(i + 1) % face.size()], sharpness()});
        for (uint32_t v = 0; v < cage_.positions.size(); ++v)
            if (pick(20) < density) cage_.corners.push_back({v, sharpness()});
        cage_.boundary = static_cast<SubdivisionCage::Boundary>(pick(3));
        cage_.faceVarying = static_cast<SubdivisionCage::FaceVarying>(pick(6));
        cage_.chaikin = pick(5) == 0;
        cage_.smoothTriangles = pick(5) == 0;
        if (pick(6) == 0) cage_.scheme = SubdivisionCage::Scheme::Bilinear;
        if (pick(10) == 0) cage_.holes.push_back(static_cast<uint32_t>(pick(static_cast<int>(faces.size()))));
    }
    std::mt19937_64 random_;
    SubdivisionCage cage_;
};

/// How far a vertex is from an average of the cage's vertices, and its tangents from differences of them.
float worstError(const SubdivisionSurface& surface) {
    float worst = 0;
    for (size_t row = 0; row + 1 < surface.first.size(); ++row) {
        double weight = -1, u = 0, v = 0;
        for (uint32_t k = surface.first[row]; k < surface.first[row + 1]; ++k) {
            weight += surface.weight[k];
            u += surface.tangentU[k];
            v += surface.tangentV[k];
        }
        for (const double error : {weight, u, v}) worst = std::max(worst, static_cast<float>(std::abs(error)));
    }
    return worst;
}

TEST(RandomCages, TessellateIntoAveragesOfTheirVertices) {
    const char* text = std::getenv("LUMISCOPE_MUTATIONS");
    const int count = text ? std::atoi(text) : 500;
    size_t triangles = 0;
    for (int i = 0; i < count; ++i) {
        const SubdivisionCage cage = RandomCage(12000000 + static_cast<uint64_t>(i)).make();
        const SubdivisionSurface surface = tessellate(cage, 2, "cage");
        triangles += surface.mesh.triangles.size();
        EXPECT_LT(worstError(surface), 1e-3f) << "seed " << i;
        for (const Vec3& p : surface.mesh.positions) ASSERT_TRUE(isFinite(p)) << "seed " << i;
        for (const Vec2& uv : surface.mesh.uv[0]) ASSERT_TRUE(std::isfinite(uv.x + uv.y)) << "seed " << i;
    }
    EXPECT_GT(triangles, 20 * static_cast<size_t>(count));
}

}  // namespace
}  // namespace lumi
