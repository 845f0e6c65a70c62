#include <algorithm>
#include <cmath>

#include "scene/procedural/mesh_tools.h"

namespace lumi {
namespace {

template <class T>
T catmullRom(const T& a, const T& b, const T& c, const T& d, float t) {
    return 0.5f * ((2.0f * b) + (c - a) * t + (2.0f * a - 5.0f * b + 4.0f * c - d) * (t * t) +
                   (3.0f * b - a - 3.0f * c + d) * (t * t * t));
}

Vec2 place(const ProfilePoint& p) { return {p.radius, p.height}; }

/// Outward normal of the span from a to b in the (radius, height) plane.
Vec2 spanNormal(const Vec2& a, const Vec2& b) {
    const Vec2 d = b - a;
    const float length = glm::length(d);
    return length > 0 ? Vec2(d.y, -d.x) / length : Vec2(0);
}

Vec2 unitOr(const Vec2& v, const Vec2& fallback) {
    const float length = glm::length(v);
    return length > 1e-12f ? v / length : fallback;
}

}  // namespace

Profile smoothProfile(const Profile& points, int steps) {
    Profile out;
    const auto last = static_cast<int>(points.size()) - 1;
    for (int i = 0; i < last; ++i) {
        const ProfilePoint &b = points[static_cast<size_t>(i)], &c = points[static_cast<size_t>(i) + 1];
        // A curve that ends at a sharp point or at the profile's end continues straight beyond it.
        const Vec2 before = b.sharp || i == 0 ? 2.0f * place(b) - place(c) : place(points[static_cast<size_t>(i) - 1]);
        const Vec2 after =
            c.sharp || i + 1 == last ? 2.0f * place(c) - place(b) : place(points[static_cast<size_t>(i) + 2]);
        out.push_back(b);
        for (int k = 1; k < steps; ++k) {
            const Vec2 p =
                catmullRom(before, place(b), place(c), after, static_cast<float>(k) / static_cast<float>(steps));
            out.push_back({std::max(p.x, 0.0f), p.y, false});
        }
    }
    out.push_back(points.back());
    return out;
}

Mesh lathe(const Profile& profile, int segments) {
    Mesh mesh;
    const auto columns = static_cast<uint32_t>(segments + 1);
    const size_t count = profile.size();
    const bool loop = count > 2 && place(profile.front()) == place(profile.back());
    float widest = 0, along = 0;
    for (const ProfilePoint& p : profile) widest = std::max(widest, p.radius);

    const auto ring = [&](const ProfilePoint& p, Vec2 normal) {
        for (int i = 0; i <= segments; ++i) {
            const float angle = 2 * kPi * static_cast<float>(i % segments) / static_cast<float>(segments);
            const float c = std::cos(angle), s = -std::sin(angle);
            mesh.positions.push_back({p.radius * c, p.height, p.radius * s});
            mesh.normals.push_back({normal.x * c, normal.y, normal.x * s});
            mesh.uv[0].push_back({2 * kPi * widest * static_cast<float>(i) / static_cast<float>(segments), along});
        }
    };
    const auto normalAt = [&](size_t i, bool startsSpan) {
        const bool first = i == 0, final = i + 1 == count;
        const Vec2 into = first ? (loop ? spanNormal(place(profile[count - 2]), place(profile[0])) : Vec2(0))
                                : spanNormal(place(profile[i - 1]), place(profile[i]));
        const Vec2 from = final ? (loop ? spanNormal(place(profile[0]), place(profile[1])) : Vec2(0))
                                : spanNormal(place(profile[i]), place(profile[i + 1]));
        if (profile[i].sharp) return startsSpan ? unitOr(from, into) : unitOr(into, from);
        if (profile[i].radius == 0) return Vec2(0, into.y + from.y < 0 ? -1 : 1);
        return unitOr(into + from, into);
    };
    for (size_t i = 0; i + 1 < count; ++i) {
        const auto base = static_cast<uint32_t>(mesh.positions.size());
        ring(profile[i], normalAt(i, true));
        along += glm::length(place(profile[i + 1]) - place(profile[i]));
        ring(profile[i + 1], normalAt(i + 1, false));
        for (uint32_t k = 0; k + 1 < columns; ++k) {
            const uint32_t a = base + k, b = base + columns + k;
            if (profile[i].radius > 0) mesh.triangles.push_back({a, a + 1, b + 1});
            if (profile[i + 1].radius > 0) mesh.triangles.push_back({a, b + 1, b});
        }
    }
    tidy(mesh);
    return mesh;
}

std::vector<Vec3> curveThrough(const std::vector<Vec3>& points, int count) {
    std::vector<Vec3> out;
    const auto spans = static_cast<int>(points.size()) - 1;
    for (int k = 0; k < count; ++k) {
        const float t = static_cast<float>(spans) * static_cast<float>(k) / static_cast<float>(count - 1);
        const int i = std::min(static_cast<int>(t), spans - 1);
        const auto at = [&](int j) {
            if (j < 0) return 2.0f * points[0] - points[1];
            if (j > spans) return 2.0f * points[static_cast<size_t>(spans)] - points[static_cast<size_t>(spans) - 1];
            return points[static_cast<size_t>(j)];
        };
        out.push_back(catmullRom(at(i - 1), at(i), at(i + 1), at(i + 2), t - static_cast<float>(i)));
    }
    return out;
}

Mesh tube(const std::vector<Vec3>& path, const std::vector<float>& radii, int segments, bool capped) {
    // Frames are carried along the path without twist; a round cap is three more rings and a pole.
    std::vector<Vec3> centres;
    std::vector<float> radiusAt;
    const size_t last = path.size() - 1;
    const Vec3 startDir = glm::normalize(path[1] - path[0]), endDir = glm::normalize(path[last] - path[last - 1]);
    const auto cap = [&](const Vec3& centre, const Vec3& dir, float radius, bool atEnd) {
        for (int k = 0; k < 4; ++k) {
            const float a = 0.125f * kPi * static_cast<float>(atEnd ? k + 1 : 4 - k);
            centres.push_back(centre + dir * (radius * std::sin(a)));
            radiusAt.push_back(k == (atEnd ? 3 : 0) ? 0 : radius * std::cos(a));
        }
    };
    if (capped) cap(path[0], -startDir, radii[0], false);
    centres.insert(centres.end(), path.begin(), path.end());
    radiusAt.insert(radiusAt.end(), radii.begin(), radii.end());
    if (capped) cap(path[last], endDir, radii[last], true);

    const auto count = static_cast<int>(centres.size());
    std::vector<Vec3> xs(centres.size()), ys(centres.size());
    Vec3 x = Frame(startDir).x;
    float along = 0;
    std::vector<float> length(centres.size());
    for (size_t i = 0; i < centres.size(); ++i) {
        const Vec3 dir = glm::normalize(centres[std::min(i + 1, centres.size() - 1)] - centres[i == 0 ? 0 : i - 1]);
        x = glm::normalize(x - dir * glm::dot(x, dir));
        xs[i] = x, ys[i] = glm::cross(dir, x);
        if (i > 0) along += glm::length(centres[i] - centres[i - 1]);
        length[i] = along;
    }
    Mesh mesh = gridSurface(
        segments, count - 1,
        [&](float u, float v) {
            const auto i = static_cast<size_t>(std::lround(v * static_cast<float>(count - 1)));
            const float a = 2 * kPi * u;
            return centres[i] + radiusAt[i] * (std::cos(a) * xs[i] + std::sin(a) * ys[i]);
        },
        Vec2(2 * kPi * radii[0], along), true);
    return mesh;
}

Mesh moulding(const std::vector<Vec2>& section, const std::vector<Vec3>& path, const std::vector<Vec3>& outward,
              const Vec3& up) {
    Mesh mesh;
    for (size_t i = 0; i + 1 < path.size(); ++i) {
        const float length = glm::length(path[i + 1] - path[i]);
        float along = 0;
        for (size_t k = 0; k + 1 < section.size(); ++k) {
            const float step = glm::length(section[k + 1] - section[k]);
            const auto at = [&](size_t station, const Vec2& s) {
                return path[station] + outward[station] * s.x + up * s.y;
            };
            const auto base = static_cast<uint32_t>(mesh.positions.size());
            for (const Vec3& p :
                 {at(i, section[k]), at(i + 1, section[k]), at(i + 1, section[k + 1]), at(i, section[k + 1])})
                mesh.positions.push_back(p);
            for (const Vec2& uv :
                 {Vec2(0, along), Vec2(length, along), Vec2(length, along + step), Vec2(0, along + step)})
                mesh.uv[0].push_back(uv);
            mesh.triangles.push_back({base, base + 1, base + 2});
            mesh.triangles.push_back({base, base + 2, base + 3});
            along += step;
        }
    }
    smoothNormals(mesh, 35);
    tidy(mesh);
    return mesh;
}

}  // namespace lumi
