#include "scene/procedural/generators.h"

namespace lumi {
namespace {

constexpr uint32_t kSeat = 0, kFrame = 1;

/// A school chair: seat and back of bent plywood on a frame of tubes.
class Chair final : public Procedural {
public:
    void describe(ParameterVisitor& v) override {
        describeLength(v, "width", width_, "Width", 0.2, 1.5, "Of the seat");
        describeLength(v, "depth", depth_, "Depth", 0.2, 1.5, "Of the seat");
        describeLength(v, "seat-height", seatHeight_, "Seat height", 0.15, 1.2, "Of the seat's top");
        describeLength(v, "height", height_, "Height", 0.3, 2, "Of the back");
    }

    ProceduralResult build() const override {
        Mesh mesh;
        const float x = width_ / 2 - 0.02f, front = depth_ / 2 - 0.03f, back = -depth_ / 2 + 0.02f;
        append(mesh, bentBoard(width_, depth_, 0.012f, 0.02f), kSeat, placed({0, seatHeight_ - 0.012f, 0}));
        const float board = 0.42f * (height_ - seatHeight_);
        append(mesh, bentBoard(width_, board, 0.011f, 0.028f), kSeat,
               placed({0, height_ - board / 2, back - 0.055f}, {80, 0, 0}));
        constexpr float kTube = 0.011f;
        for (const float s : {-1.0f, 1.0f}) {
            append(mesh, bow({{s * x, seatHeight_ - 0.02f, front}, {s * x, 0.006f, front + 0.03f}}, kTube), kFrame);
            append(mesh,
                   bow({{s * x, 0.006f, back - 0.05f},
                        {s * x, seatHeight_ - 0.02f, back},
                        {s * x, height_ - 0.05f, back - 0.065f}},
                       kTube),
                   kFrame);
            append(mesh, bow({{s * x, seatHeight_ - 0.022f, front}, {s * x, seatHeight_ - 0.022f, back}}, kTube),
                   kFrame);
            append(mesh, bow({{s * x, 0.16f, front + 0.02f}, {s * x, 0.16f, back - 0.032f}}, 0.8f * kTube), kFrame);
        }
        append(mesh, bow({{-x, 0.16f, back - 0.032f}, {x, 0.16f, back - 0.032f}}, 0.8f * kTube), kFrame);
        return onePart(std::move(mesh), {opaqueSlot("seat", {0.46f, 0.28f, 0.13f}, 0.35f),
                                         opaqueSlot("frame", {0.06f, 0.07f, 0.08f}, 0.35f)});
    }

private:
    /// A board in the XZ plane, hollow across X by `sag`.
    static Mesh bentBoard(float width, float depth, float thickness, float sag) {
        Mesh bent;
        constexpr int kPieces = 16;
        const auto height = [&](float u) { return sag * (4 * (u - 0.5f) * (u - 0.5f) - 1); };
        for (const float side : {1.0f, -1.0f})
            append(bent, gridSurface(
                             kPieces, 2,
                             [&](float u, float v) {
                                 const float across = side > 0 ? u : 1 - u;
                                 return Vec3((across - 0.5f) * width, height(across) + side * 0.5f * thickness,
                                             (0.5f - v) * depth);
                             },
                             Vec2(width, depth)));
        for (const float side : {1.0f, -1.0f})
            append(bent, gridSurface(
                             kPieces, 1,
                             [&](float u, float v) {
                                 const float across = side > 0 ? u : 1 - u;
                                 return Vec3((across - 0.5f) * width, height(across) + (v - 0.5f) * thickness,
                                             side * 0.5f * depth);
                             },
                             Vec2(width, thickness)));
        for (const float side : {1.0f, -1.0f})
            append(bent, gridSurface(
                             1, 1,
                             [&](float u, float v) {
                                 return Vec3(side * 0.5f * width, height(0) + (v - 0.5f) * thickness,
                                             side * (0.5f - u) * depth);
                             },
                             Vec2(depth, thickness)));
        return bent;
    }

    static Mesh bow(const std::vector<Vec3>& points, float radius) {
        const std::vector<Vec3> path = points.size() > 2 ? curveThrough(points, 12) : points;
        return tube(path, std::vector<float>(path.size(), radius), 10);
    }

    float width_ = 0.4f, depth_ = 0.4f, seatHeight_ = 0.45f, height_ = 0.82f;
};

}  // namespace

std::unique_ptr<Procedural> makeChair() { return std::make_unique<Chair>(); }

}  // namespace lumi
