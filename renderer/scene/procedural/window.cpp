#include "scene/procedural/generators.h"

namespace lumi {
namespace {

/// A window frame in the XY plane, its lower edge on y = 0: casings, mullions, a sill towards +Z. No glass.
class Window final : public Procedural {
public:
    void describe(ParameterVisitor& v) override {
        describeLength(v, "width", width_, "Width", 0.2, 20, "Of the opening that it fills");
        describeLength(v, "height", height_, "Height", 0.2, 10, "Of the opening that it fills");
        describeCount(v, "columns", columns_, "Columns", 1, 12, "Panes side by side");
        describeCount(v, "rows", rows_, "Rows", 1, 12, "Panes above each other");
        describeLength(v, "sill", sill_, "Sill", 0, 1, "How far the sill board stands out");
    }

    ProceduralResult build() const override {
        Mesh mesh;
        const float frame = 0.055f, deep = 0.07f, bar = 0.026f;
        const auto vertical = [&](float x, float wide, float thick) {
            append(mesh, roundedBox({wide, height_, thick}, 0.006f, 2), 0, placed({x, height_ / 2, 0}));
        };
        const auto horizontal = [&](float y, float wide, float thick) {
            append(mesh, roundedBox({width_, wide, thick}, 0.006f, 2), 0, placed({0, y, 0}));
        };
        vertical(-width_ / 2 + frame / 2, frame, deep), vertical(width_ / 2 - frame / 2, frame, deep);
        horizontal(frame / 2, frame, deep), horizontal(height_ - frame / 2, frame, deep);
        const float innerW = width_ - 2 * frame, innerH = height_ - 2 * frame;
        for (int i = 1; i < columns_; ++i) {
            // Every second bar is where two casements meet: wider and deeper.
            const bool casement = i % 2 == 0 || columns_ == 2;
            vertical(-innerW / 2 + innerW * static_cast<float>(i) / static_cast<float>(columns_),
                     casement ? 0.075f : bar, casement ? 0.06f : 0.034f);
        }
        for (int i = 1; i < rows_; ++i)
            horizontal(frame + innerH * static_cast<float>(i) / static_cast<float>(rows_), bar, 0.034f);
        if (sill_ > 0)
            append(mesh, roundedBox({width_ + 0.12f, 0.03f, sill_}, 0.012f, 4), 0, placed({0, 0, sill_ / 2}));
        return onePart(std::move(mesh), {opaqueSlot("surface", {0.82f, 0.81f, 0.78f}, 0.35f)});
    }

private:
    float width_ = 2.2f, height_ = 1.7f, sill_ = 0.25f;
    int columns_ = 4, rows_ = 3;
};

}  // namespace

std::unique_ptr<Procedural> makeWindow() { return std::make_unique<Window>(); }

}  // namespace lumi
