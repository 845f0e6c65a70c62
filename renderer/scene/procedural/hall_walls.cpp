#include <algorithm>

#include "scene/procedural/hall_parts.h"

namespace lumi::hall {
namespace {

constexpr int kArchSteps = 16;

/// Where the ray from the arch's centre at `angle` leaves the panel above the springing line.
Vec2 panelBorder(float angle, float halfWidth, float above) {
    const float c = std::cos(angle), s = std::sin(angle);
    const float t = std::min(std::abs(c) > 1e-6f ? halfWidth / std::abs(c) : 1e9f, s > 1e-6f ? above / s : 1e9f);
    return {t * c, t * s};
}

/// Angles of the arch from right to left, with the panel's corners among them.
std::vector<float> archAngles(float halfWidth, float above) {
    std::vector<float> angles;
    for (int i = 0; i <= kArchSteps; ++i) angles.push_back(kPi * static_cast<float>(i) / kArchSteps);
    const float corner = std::atan2(above, halfWidth);
    angles.push_back(corner), angles.push_back(kPi - corner);
    std::sort(angles.begin(), angles.end());
    angles.erase(std::unique(angles.begin(), angles.end(), [](float a, float b) { return b - a < 1e-4f; }),
                 angles.end());
    return angles;
}

/// One face of the panel at z, front towards +Z.
Mesh panelFace(float width, float height, float spring, float radius, float z) {
    Mesh mesh;
    const float hw = width / 2;
    const auto quad = [&](Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
        const auto base = static_cast<uint32_t>(mesh.positions.size());
        for (const Vec2& p : {a, b, c, d}) {
            mesh.positions.push_back(Vec3(p, z));
            mesh.uv[0].push_back(p);
        }
        mesh.triangles.push_back({base, base + 1, base + 2});
        mesh.triangles.push_back({base, base + 2, base + 3});
    };
    quad({radius, 0}, {hw, 0}, {hw, spring}, {radius, spring});
    quad({-hw, 0}, {-radius, 0}, {-radius, spring}, {-hw, spring});
    const std::vector<float> angles = archAngles(hw, height - spring);
    const Vec2 centre(0, spring);
    for (size_t i = 0; i + 1 < angles.size(); ++i) {
        const Vec2 a0 = centre + radius * Vec2(std::cos(angles[i]), std::sin(angles[i]));
        const Vec2 a1 = centre + radius * Vec2(std::cos(angles[i + 1]), std::sin(angles[i + 1]));
        quad(a0, centre + panelBorder(angles[i], hw, height - spring),
             centre + panelBorder(angles[i + 1], hw, height - spring), a1);
    }
    mesh.normals.assign(mesh.positions.size(), Vec3(0, 0, 1));
    return mesh;
}

/// Moulded ring around the arch on the face at z = 0, standing out towards +Z, with a keystone.
Mesh archivolt(float spring, float radius) {
    const float w = std::min(0.26f, radius * 0.24f);
    const std::vector<Vec2> section = {
        {0, -0.02f},         {0, 0.030f},         {0.30f * w, 0.030f}, {0.30f * w, 0.048f}, {0.62f * w, 0.048f},
        {0.66f * w, 0.064f}, {0.78f * w, 0.082f}, {0.92f * w, 0.086f}, {w, 0.070f},         {w, 0}};
    std::vector<Vec3> path, outward;
    for (int i = 0; i <= kArchSteps; ++i) {
        const float a = kPi * static_cast<float>(i) / kArchSteps;
        const Vec3 d(std::cos(a), std::sin(a), 0);
        path.push_back(Vec3(0, spring, 0) + d * radius);
        outward.push_back(d);
    }
    Mesh mesh = moulding(section, path, outward, {0, 0, 1});
    Mesh all;
    append(all, mesh);
    const float k = w * 0.42f;
    append(all,
           extrude({{-k * 0.8f, -0.05f}, {k * 0.8f, -0.05f}, {k * 1.25f, w * 1.3f}, {-k * 1.25f, w * 1.3f}},
                   {0, w * 0.5f}, 0.26f, 0.012f),
           0, placed({0, spring + radius, 0}));
    return all;
}

/// The half of an arch between two bays that lies inwards (-Z) of the edge z = 0: soffit and side face.
Mesh edgeBand(float span, float rise, float band, float thick) {
    Mesh mesh;
    const auto at = [&](float u, float inset) {
        const float a = kPi * u;
        return Vec2(-(span / 2 - inset) * std::cos(a), (rise - inset) * std::sin(a));
    };
    append(mesh,
           gridSurface(
               16, 1, [&](float u, float v) { return Vec3(at(u, thick), -band * (1 - v)); }, Vec2(span * 1.5f, band)));
    turnInsideOut(mesh);
    append(mesh,
           gridSurface(
               16, 1, [&](float u, float v) { return Vec3(at(u, thick * (1 - v)), -band); }, Vec2(span * 1.5f, thick)));
    return mesh;
}

}  // namespace

Mesh archPanel(float width, float height, float thickness, float spring, float radius, bool bothFaces) {
    Mesh mesh;
    const float z = thickness / 2;
    const Mesh face = panelFace(width, height, spring, radius, z);
    append(mesh, face, kStone);
    append(mesh, face, kStone, placed({0, 0, 0}, {0, 180, 0}));
    // Intrados and jambs, seen from inside the opening.
    std::vector<Vec2> edge = {{radius, 0}};
    for (int i = 0; i <= kArchSteps; ++i) {
        const float a = kPi * static_cast<float>(i) / kArchSteps;
        edge.push_back({radius * std::cos(a), spring + radius * std::sin(a)});
    }
    edge.push_back({-radius, 0});
    const auto last = static_cast<float>(edge.size() - 1);
    Mesh soffit = gridSurface(
        static_cast<int>(edge.size()) - 1, 1,
        [&](float u, float v) {
            const Vec2 p = edge[static_cast<size_t>(std::lround(u * last))];
            return Vec3(p, glm::mix(-z, z, v));
        },
        Vec2(2 * spring + kPi * radius, thickness));
    turnInsideOut(soffit);
    append(mesh, soffit, kStone);
    const Mesh ring = archivolt(spring, radius);
    append(mesh, ring, kTrim, placed({0, 0, z}));
    if (bothFaces) append(mesh, ring, kTrim, placed({0, 0, -z}, {0, 180, 0}));
    return mesh;
}

Mesh balustrade(float width, float height, float balusterPitch) {
    Mesh mesh;
    const float foot = 0.14f, rail = 0.11f, deep = 0.26f, tall = height - foot - rail;
    append(mesh, roundedBox({width, foot, deep}, 0.012f, 1), kTrim, placed({0, foot / 2, 0}));
    append(mesh, roundedBox({width, rail * 0.55f, deep * 1.16f}, 0.018f, 2), kTrim,
           placed({0, height - rail * 0.275f, 0}));
    append(mesh, roundedBox({width, rail * 0.5f, deep * 0.86f}, 0.008f, 1), kTrim,
           placed({0, height - rail * 0.78f, 0}));
    const float r = 0.078f;
    const Profile turned = smoothProfile({{0, 0},
                                          {r, 0, true},
                                          {r, tall * 0.07f, true},
                                          {r * 0.62f, tall * 0.10f},
                                          {r * 0.60f, tall * 0.13f},
                                          {r * 0.98f, tall * 0.26f},
                                          {r * 1.02f, tall * 0.34f},
                                          {r * 0.62f, tall * 0.56f},
                                          {r * 0.42f, tall * 0.76f},
                                          {r * 0.46f, tall * 0.82f, true},
                                          {r * 0.70f, tall * 0.85f},
                                          {r * 0.46f, tall * 0.88f, true},
                                          {r * 0.55f, tall * 0.92f, true},
                                          {r * 0.95f, tall * 0.95f, true},
                                          {r * 0.95f, tall, true},
                                          {0, tall}},
                                         1);
    const Mesh baluster = lathe(turned, 8);
    const int count = std::max(1, static_cast<int>(width / balusterPitch));
    for (int i = 0; i < count; ++i)
        append(mesh, baluster, kTrim,
               placed({width * ((static_cast<float>(i) + 0.5f) / static_cast<float>(count) - 0.5f), foot, 0}));
    return mesh;
}

Mesh groinVault(float width, float depth, float rise, float band) {
    Mesh mesh;
    const auto heightAt = [&](float x, float z) {
        // Two crossing barrels, elliptical when the bay is oblong; the groins are where they meet.
        const float alongX = std::sqrt(std::max(0.0f, 1 - sqr(2 * x / width)));
        const float alongZ = std::sqrt(std::max(0.0f, 1 - sqr(2 * z / depth)));
        return rise * std::max(alongX, alongZ);
    };
    const auto spaced = [](float t) { return 0.5f - 0.5f * std::cos(kPi * t); };  // denser where the barrels are steep
    Mesh shell = gridSurface(
        12, 12,
        [&](float u, float v) {
            const float x = (spaced(u) - 0.5f) * width, z = (spaced(v) - 0.5f) * depth;
            return Vec3(x, heightAt(x, z), z);
        },
        Vec2(width, depth));
    smoothNormals(shell, 35);
    append(mesh, shell, kVault);
    const float thick = 0.055f;
    for (const float sign : {-1.0f, 1.0f}) {
        std::vector<Vec3> path;
        for (int i = 0; i <= 12; ++i) {
            const float t = spaced(static_cast<float>(i) / 12) - 0.5f;
            path.push_back({t * width, heightAt(t * width, t * depth) - thick * 0.2f, sign * t * depth});
        }
        append(mesh, tube(path, std::vector<float>(path.size(), thick), 4, false), kTrim);
    }
    for (int side = 0; side < 4; ++side) {
        const float span = side % 2 == 0 ? width : depth, across = side % 2 == 0 ? depth : width;
        append(mesh, edgeBand(span, rise, band, 0.11f), kTrim,
               placed({0, 0, 0}, {0, 90.0f * static_cast<float>(side), 0}) * placed({0, 0, across / 2}));
    }
    append(mesh,
           lathe(smoothProfile(
                     {{0, rise - 0.14f}, {0.07f, rise - 0.13f}, {0.15f, rise - 0.09f}, {0.17f, rise - 0.02f, true}}, 2),
                 9),
           kTrim);
    return mesh;
}

Mesh flatPatch(const Vec3& corner, const Vec3& right, const Vec3& up) {
    return gridSurface(
        1, 1, [&](float u, float v) { return corner + right * u + up * v; }, Vec2(glm::length(right), glm::length(up)));
}

Mesh archDoor(float spring, float radius) {
    Mesh mesh;
    const int planks = 7;
    const float wide = 2 * radius / planks;
    for (int i = 0; i < planks; ++i) {
        const float x = -radius + wide * (static_cast<float>(i) + 0.5f);
        const float inner = std::max(0.0f, std::abs(x) - wide * 0.3f);
        const float top = spring + std::sqrt(std::max(0.0f, radius * radius - inner * inner)) + 0.03f;
        append(mesh, roundedBox({wide - 0.006f, top, 0.05f}, 0.008f, 1), kWood, placed({x, top / 2, 0}));
    }
    for (const float y : {0.35f, spring - 0.15f}) {
        append(mesh, roundedBox({2 * radius, 0.09f, 0.012f}, 0.004f, 1), kMetal, placed({0, y, 0.03f}));
        for (int i = 0; i < planks; ++i)
            append(mesh, lathe({{0.016f, 0}, {0.013f, 0.007f}, {0, 0.011f}}, 5), kMetal,
                   placed({-radius + wide * (static_cast<float>(i) + 0.5f), y, 0.036f}, {90, 0, 0}));
    }
    std::vector<Vec3> ring;
    for (int k = 0; k <= 14; ++k) {
        const float a = 2 * kPi * static_cast<float>(k) / 14;
        ring.push_back({0.12f + 0.07f * std::sin(a), 1.02f - 0.07f * std::cos(a), 0.045f});
    }
    append(mesh, tube(ring, std::vector<float>(ring.size(), 0.009f), 5, false), kMetal);
    return mesh;
}

Mesh cornice(float length, float height, float reach, bool dentils) {
    Mesh mesh;
    const std::vector<Vec2> section = {{0, -height},
                                       {0.10f * reach, -height},
                                       {0.12f * reach, -0.88f * height},
                                       {0.22f * reach, -0.82f * height},
                                       {0.30f * reach, -0.66f * height},
                                       {0.34f * reach, -0.60f * height},
                                       {0.36f * reach, -0.42f * height},
                                       {0.74f * reach, -0.38f * height},
                                       {0.76f * reach, -0.22f * height},
                                       {0.84f * reach, -0.18f * height},
                                       {0.96f * reach, -0.05f * height},
                                       {reach, 0},
                                       {0, 0.004f}};
    append(
        mesh,
        moulding(section, {Vec3(length / 2, 0, 0), Vec3(-length / 2, 0, 0)}, {Vec3(0, 0, 1), Vec3(0, 0, 1)}, {0, 1, 0}),
        kTrim);
    if (dentils) {
        const float pitch = 0.16f;
        const int count = static_cast<int>(length / pitch);
        const Mesh block = sharpBox({length / static_cast<float>(count) * 0.55f, 0.16f * height, 0.30f * reach});
        for (int i = 0; i < count; ++i)
            append(mesh, block, kTrim,
                   placed({length * ((static_cast<float>(i) + 0.5f) / static_cast<float>(count) - 0.5f),
                           -0.50f * height, 0.48f * reach}));
    }
    return mesh;
}

}  // namespace lumi::hall
