#include "scene/procedural/hall_parts.h"

namespace lumi::hall {
namespace {

/// A leaf of the capital: rises along the bell and curls outwards at its tip.
Mesh acanthus(float height, float width, float radius, float flare) {
    return gridSurface(3, 5, [&](float u, float v) {
        const float across = 2 * u - 1;
        const float half =
            0.5f * width * std::sqrt(std::max(0.0f, 1 - std::pow(v, 3.0f) * 0.9f)) * (1 + 0.10f * std::cos(v * 19));
        const float curl = glm::smoothstep(0.55f, 1.0f, v);
        const float out = radius + flare * (0.35f * v * v + 1.1f * curl) + 0.10f * width * (1 - across * across);
        const float up = height * (v - 0.30f * curl * curl);
        return Vec3(across * half, up, out);
    });
}

Mesh spiral(float size, float thickness) {
    std::vector<Vec3> path;
    std::vector<float> radii;
    for (int i = 0; i <= 13; ++i) {
        const float t = static_cast<float>(i) / 13, a = t * 4.2f * kPi, r = size * (1 - 0.85f * t);
        path.push_back({r * std::cos(a), r * std::sin(a), thickness * 1.5f * t});
        radii.push_back(thickness * (1 - 0.5f * t));
    }
    return tube(path, radii, 4);
}

Mesh capital(float radius, float height) {
    Mesh mesh;
    const float bell = height * 0.82f;
    append(mesh, lathe(smoothProfile({{0, 0},
                                      {radius, 0, true},
                                      {radius * 1.12f, height * 0.025f},
                                      {radius * 1.12f, height * 0.05f},
                                      {radius, height * 0.075f, true},
                                      {radius * 1.02f, height * 0.3f},
                                      {radius * 1.14f, height * 0.6f},
                                      {radius * 1.42f, bell, true},
                                      {0, bell}},
                                     2),
                       24));
    const Mesh low = acanthus(height * 0.44f, radius * 0.80f, radius * 1.01f, radius * 0.34f);
    const Mesh high = acanthus(height * 0.72f, radius * 0.74f, radius * 1.04f, radius * 0.44f);
    for (int i = 0; i < 8; ++i) {
        const float turn = 45.0f * static_cast<float>(i);
        append(mesh, low, 0, placed({0, height * 0.08f, 0}, {0, turn, 0}));
        append(mesh, high, 0, placed({0, height * 0.08f, 0}, {0, turn + 22.5f, 0}));
    }
    const Mesh volute = spiral(radius * 0.27f, radius * 0.095f);
    for (int corner = 0; corner < 4; ++corner) {
        const Mat4 turn = placed({0, 0, 0}, {0, 45.0f + 90.0f * static_cast<float>(corner), 0});
        const Vec3 at(0, height * 0.72f, radius * 1.48f);
        append(mesh, volute, 0, turn * placed(at, {0, 90, 0}));
    }
    append(mesh, roundedBox({radius * 3.05f, height * 0.09f, radius * 3.05f}, 0.012f, 1), 0,
           placed({0, bell + height * 0.045f, 0}));
    append(mesh, roundedBox({radius * 3.25f, height * 0.09f, radius * 3.25f}, 0.018f, 1), 0,
           placed({0, bell + height * 0.135f, 0}));
    return mesh;
}

}  // namespace

Mesh column(float height, float radius, int flutes) {
    Mesh mesh;
    const float r = radius, plinth = 0.55f * r, base = 0.75f * r, cap = 2.2f * r;
    append(mesh, roundedBox({r * 2.9f, plinth, r * 2.9f}, 0.012f, 1), kTrim, placed({0, plinth / 2, 0}));
    append(mesh,
           lathe(smoothProfile({{0, plinth},
                                {r * 1.40f, plinth, true},
                                {r * 1.44f, plinth + base * 0.16f},
                                {r * 1.40f, plinth + base * 0.32f, true},
                                {r * 1.26f, plinth + base * 0.36f, true},
                                {r * 1.18f, plinth + base * 0.5f},
                                {r * 1.22f, plinth + base * 0.62f, true},
                                {r * 1.27f, plinth + base * 0.72f},
                                {r * 1.22f, plinth + base * 0.84f, true},
                                {r * 1.06f, plinth + base * 0.88f},
                                {r, plinth + base, true},
                                {0, plinth + base}},
                               2),
                 20),
           kTrim);
    const float y0 = plinth + base, y1 = height - cap;
    const int around = flutes > 0 ? flutes * 4 : 24;
    append(mesh,
           gridSurface(
               around, 7,
               [&](float u, float v) {
                   const float swell = 1 - 0.16f * v * v + 0.012f * std::sin(kPi * v);
                   const float ends = glm::smoothstep(0.0f, 0.035f, v) * (1 - glm::smoothstep(0.965f, 1.0f, v));
                   const float groove = flutes > 0 ? std::abs(std::sin(kPi * u * static_cast<float>(flutes))) : 0;
                   const float q = r * swell * (1 - 0.07f * ends * std::pow(groove, 0.8f)), a = -2 * kPi * u;
                   return Vec3(q * std::cos(a), glm::mix(y0, y1, v), q * std::sin(a));
               },
               Vec2(2 * kPi * r, y1 - y0), true),
           kColumn);
    append(mesh, capital(r * 0.84f, cap), kTrim, placed({0, y1, 0}));
    return mesh;
}

Mesh pier(float height, float width) {
    Mesh mesh;
    append(mesh, roundedBox({width, height, width}, 0.02f, 1), kStone, placed({0, height / 2, 0}));
    for (const auto& [y, h, grow] : {std::tuple<float, float, float>{0.0f, 0.22f, 0.10f},
                                     {0.22f, 0.05f, 0.06f},
                                     {height - 0.10f, 0.10f, 0.11f},
                                     {height - 0.16f, 0.06f, 0.07f},
                                     {height - 0.34f, 0.03f, 0.03f}})
        append(mesh, roundedBox({width + grow, h, width + grow}, 0.012f, 1), kTrim, placed({0, y + h / 2, 0}));
    return mesh;
}

Mesh lantern(float drop, float size) {
    Mesh mesh;
    append(mesh, tube({Vec3(0, 0, 0), Vec3(0, -drop, 0)}, {0.008f, 0.008f}, 5), kMetal);
    const float y = -drop, r = size * 0.5f, h = size * 1.5f;
    append(mesh,
           lathe(smoothProfile({{0, y - h * 0.32f},
                                {r * 1.15f, y - h * 0.32f, true},
                                {r * 1.12f, y - h * 0.28f},
                                {r * 0.5f, y - h * 0.12f},
                                {r * 0.2f, y - h * 0.06f},
                                {0, y}},
                               4),
                 6),
           kMetal);
    append(
        mesh,
        lathe({{0, y - h * 1.02f}, {r * 0.75f, y - h, true}, {r * 0.8f, y - h * 0.97f, true}, {0, y - h * 0.96f}}, 6),
        kMetal);
    for (int i = 0; i < 6; ++i) {
        const float a = 2 * kPi * static_cast<float>(i) / 6;
        const Vec3 d(std::cos(a), 0, std::sin(a));
        append(mesh,
               tube({d * (r * 0.76f) + Vec3(0, y - h * 0.98f, 0), d * (r * 1.05f) + Vec3(0, y - h * 0.31f, 0)},
                    {0.01f, 0.01f}, 4),
               kMetal);
    }
    Profile flame;
    for (int k = 0; k <= 10; ++k) {
        const float a = kPi * static_cast<float>(k) / 10;
        flame.push_back({k % 10 == 0 ? 0 : 0.42f * r * std::sin(a), y - h * 0.66f - 0.55f * r * std::cos(a)});
    }
    append(mesh, lathe(flame, 8), kFlame);
    return mesh;
}

}  // namespace lumi::hall
