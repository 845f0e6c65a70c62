#include "scene/procedural/generators.h"

namespace lumi {
namespace {

constexpr uint32_t kFrame = 0, kMat = 1, kPicture = 2;

/// A framed picture that hangs against z = 0, facing +Z, centred on the origin. uv of the picture runs from 0 to 1,
/// v = 0 at its top.
class PictureFrame final : public Procedural {
public:
    void describe(ParameterVisitor& v) override {
        describeLength(v, "width", width_, "Width", 0.05, 5, "Over the frame");
        describeLength(v, "height", height_, "Height", 0.05, 5, "Over the frame");
        describeLength(v, "frame", frame_, "Frame", 0.005, 0.3, "Width of the moulding");
        describeLength(v, "mat", mat_, "Mat", 0, 0.5, "Width of the cardboard around the picture");
    }

    ProceduralResult build() const override {
        Mesh mesh;
        const float x = width_ / 2, y = height_ / 2, f = frame_;
        // Outer wall, raised lip, hollow, inner lip: seen from outside to inside.
        const std::vector<Vec2> section = {{0, 0},
                                           {0, 0.020f},
                                           {0.05f * f, 0.026f},
                                           {0.22f * f, 0.028f},
                                           {0.32f * f, 0.025f},
                                           {0.5f * f, 0.016f},
                                           {0.72f * f, 0.013f},
                                           {0.82f * f, 0.016f},
                                           {0.93f * f, 0.015f},
                                           {f, 0.008f},
                                           {f, 0.004f}};
        const std::vector<Vec3> path = {{-x, -y, 0}, {-x, y, 0}, {x, y, 0}, {x, -y, 0}, {-x, -y, 0}};
        const std::vector<Vec3> inward = {{1, 1, 0}, {1, -1, 0}, {-1, -1, 0}, {-1, 1, 0}, {1, 1, 0}};
        append(mesh, moulding(section, path, inward, {0, 0, 1}), kFrame);
        const float ix = x - f, iy = y - f, px = ix - mat_, py = iy - mat_;
        const auto flat = [](float hx, float hy, float z) {
            return gridSurface(1, 1, [=](float u, float v) { return Vec3((2 * u - 1) * hx, (2 * v - 1) * hy, z); });
        };
        if (mat_ > 0) append(mesh, flat(ix, iy, 0.0045f), kMat);
        Mesh picture = flat(px, py, 0.005f);
        for (Vec2& uv : picture.uv[0]) uv.y = 1 - uv.y;
        append(mesh, picture, kPicture);
        return onePart(std::move(mesh), {opaqueSlot("frame", {0.09f, 0.06f, 0.04f}, 0.35f),
                                         opaqueSlot("mat", {0.85f, 0.83f, 0.78f}, 0.95f),
                                         opaqueSlot("picture", {0.5f, 0.5f, 0.5f}, 0.6f)});
    }

private:
    float width_ = 0.6f, height_ = 0.8f, frame_ = 0.035f, mat_ = 0.07f;
};

}  // namespace

std::unique_ptr<Procedural> makePictureFrame() { return std::make_unique<PictureFrame>(); }

}  // namespace lumi
