#include <algorithm>
#include <array>

#include "scene/procedural/generators.h"

namespace lumi {
namespace {

constexpr uint32_t kWood = 0, kCover = 1, kPages = 2, kBack = 3;

/// Cloth and leather bindings, linear.
constexpr std::array<Vec3, 14> kBindings = {{{0.30f, 0.04f, 0.03f},
                                             {0.05f, 0.12f, 0.20f},
                                             {0.03f, 0.16f, 0.12f},
                                             {0.52f, 0.38f, 0.16f},
                                             {0.10f, 0.09f, 0.09f},
                                             {0.62f, 0.56f, 0.44f},
                                             {0.42f, 0.16f, 0.05f},
                                             {0.12f, 0.22f, 0.34f},
                                             {0.24f, 0.10f, 0.16f},
                                             {0.70f, 0.66f, 0.60f},
                                             {0.18f, 0.24f, 0.10f},
                                             {0.55f, 0.25f, 0.08f},
                                             {0.07f, 0.05f, 0.12f},
                                             {0.36f, 0.32f, 0.28f}}};

/// A closed book standing on y = 0, its spine towards +Z: rounded spine, two boards, page block, bands on the spine.
Mesh book(float thickness, float height, float depth, const Vec3& colour, bool banded) {
    const float board = 0.0025f, lip = 0.004f;
    Mesh cover;
    for (const float s : {-1.0f, 1.0f})
        append(cover, roundedBox({board, height, depth}, 0.0011f, 1), kCover,
               placed({s * (thickness - board) / 2, height / 2, 0}));
    const auto spine = [&](float y0, float y1, float out) {
        return gridSurface(8, 1, [&](float u, float v) {
            const float a = kPi * (1 - u), r = thickness / 2 + out;
            return Vec3(r * std::cos(a), y0 + (y1 - y0) * v, depth / 2 + (thickness * 0.22f + out) * std::sin(a));
        });
    };
    append(cover, spine(0, height, 0), kCover);
    paint(cover, colour);
    Mesh mesh;
    append(mesh, cover);
    if (banded)
        for (const float y : {0.14f, 0.20f, 0.80f, 0.86f}) {
            Mesh band = spine(height * y, height * y + 0.004f, 0.0006f);
            paint(band, glm::mix(colour, Vec3(0.75f, 0.55f, 0.22f), 0.75f));
            append(mesh, band, kCover);
        }
    append(mesh, sharpBox({thickness - 2 * board, height - 2 * lip, depth - lip}), kPages,
           placed({0, height / 2, lip / 2}));
    return mesh;
}

Vec3 bindingColour(Dice& dice) {
    const Vec3 base = kBindings[static_cast<size_t>(dice.below(static_cast<int>(kBindings.size())))];
    return base * dice.range(0.8f, 1.2f);
}

std::vector<MaterialSlot> bookSlots() {
    return {opaqueSlot("wood", {0.30f, 0.17f, 0.09f}, 0.4f), opaqueSlot("covers", {1, 1, 1}, 0.55f),
            opaqueSlot("pages", {0.78f, 0.72f, 0.58f}, 0.95f), opaqueSlot("back", {0.24f, 0.14f, 0.08f}, 0.6f)};
}

/// A case of shelves, back to -Z, filled with rows and stacks of books and gaps for ornaments.
class Bookshelf final : public Procedural {
public:
    void describe(ParameterVisitor& v) override {
        describeLength(v, "width", width_, "Width", 0.3, 4, "Over the sides");
        describeLength(v, "height", height_, "Height", 0.4, 4, "Over the top");
        describeLength(v, "depth", depth_, "Depth", 0.15, 0.8, "Over the back");
        describeCount(v, "shelves", shelves_, "Shelves", 1, 12, "Rows of books");
        v.number(
            "fill", fill_,
            {.label = "Fill", .min = 0, .max = 1, .help = "Share of each row taken by books", .redo = Redo::Build});
        describeSeed(v, seed_);
    }

    ProceduralResult build() const override {
        Dice dice(seed_);
        Mesh mesh;
        const float board = 0.024f, plinth = 0.07f;
        for (const float s : {-1.0f, 1.0f})
            append(mesh, roundedBox({board, height_, depth_}, 0.003f, 2), kWood,
                   placed({s * (width_ - board) / 2, height_ / 2, 0}));
        append(mesh, sharpBox({width_ - board, height_ - 0.01f, 0.008f}), kBack,
               placed({0, height_ / 2, -depth_ / 2 + 0.006f}));
        append(mesh, sharpBox({width_ - 2 * board, plinth, 0.016f}), kWood,
               placed({0, plinth / 2, depth_ / 2 - 0.03f}));
        append(mesh, roundedBox({width_ + 0.03f, board * 1.3f, depth_ + 0.02f}, 0.006f, 3), kWood,
               placed({0, height_ + board * 0.6f, 0.008f}));
        const float pitch = (height_ - plinth) / static_cast<float>(shelves_);
        for (int s = 0; s < shelves_; ++s) {
            const float y = plinth + pitch * static_cast<float>(s);
            append(mesh, roundedBox({width_ - 2 * board, board, depth_ - 0.012f}, 0.003f, 2), kWood,
                   placed({0, y + board / 2, 0.004f}));
            fillRow(mesh, dice, y + board, pitch - board);
        }
        return onePart(std::move(mesh), bookSlots());
    }

private:
    void fillRow(Mesh& mesh, Dice& dice, float y, float room) const {
        const float left = -width_ / 2 + 0.032f, right = width_ / 2 - 0.032f;
        float x = left;
        while (x < right - 0.05f) {
            if (dice.unit() > fill_) {
                x += dice.range(0.06f, 0.16f);
                continue;
            }
            if (dice.unit() < 0.16f && right - x > 0.3f) x += addPile(mesh, dice, x, y, room);
            else x = addRun(mesh, dice, x, y, room, std::min(right, x + dice.range(0.18f, 0.5f)));
        }
    }

    /// Upright books of similar size; the last leans on the others.
    float addRun(Mesh& mesh, Dice& dice, float x, float y, float room, float end) const {
        const float tall = room * dice.range(0.66f, 0.86f), deep = depth_ * dice.range(0.58f, 0.74f);
        Vec3 colour = bindingColour(dice);
        const bool series = dice.unit() < 0.35f;
        while (true) {
            const float t = series ? 0.031f : dice.range(0.016f, 0.048f);
            if (x + t > end) break;
            const float h = series ? tall : std::min(tall * dice.range(0.84f, 1.08f), room * 0.94f);
            if (!series) colour = bindingColour(dice);
            const float d = series ? deep : deep * dice.range(0.92f, 1.06f);
            append(mesh, book(t, h, d, colour, series || dice.unit() < 0.4f), 0,
                   placed({x + t / 2, y, depth_ / 2 - 0.028f - d / 2 - dice.range(0, 0.015f)}));
            x += t + 0.0015f;
        }
        const float t = dice.range(0.018f, 0.035f), h = tall * 0.9f, lean = dice.range(7, 13);
        const float reach = h * std::sin(radians(lean)) + t;
        if (x + reach < end + 0.08f && x + reach < width_ / 2 - 0.035f) {
            append(mesh, book(t, h, deep, bindingColour(dice), true), 0,
                   placed({x + reach - t / 2, y + t / 2 * std::sin(radians(lean)), depth_ / 2 - 0.03f - deep / 2},
                          {0, 0, lean}));
            x += reach + 0.01f;
        }
        return x + 0.004f;
    }

    /// A few books lying flat; returns how much of the row they take.
    float addPile(Mesh& mesh, Dice& dice, float x, float y, float room) const {
        const int count = 2 + dice.below(4);
        float top = y;
        for (int i = 0; i < count; ++i) {
            const float t = dice.range(0.02f, 0.042f);
            if (top + t > y + room * 0.8f) break;
            append(mesh, book(t, dice.range(0.20f, 0.24f), depth_ * 0.62f, bindingColour(dice), true), 0,
                   placed({x + 0.245f, top + t / 2, depth_ / 2 - 0.035f - depth_ * 0.31f}, {0, dice.range(-4, 4), 90}));
            top += t + 0.0005f;
        }
        return 0.26f;
    }

    float width_ = 1.1f, height_ = 2.05f, depth_ = 0.33f, fill_ = 0.88f;
    int shelves_ = 6, seed_ = 1;
};

/// Books lying on each other, for tables.
class BookStack final : public Procedural {
public:
    void describe(ParameterVisitor& v) override {
        describeCount(v, "books", books_, "Books", 1, 20, "In the stack");
        describeSeed(v, seed_);
    }

    ProceduralResult build() const override {
        Dice dice(seed_);
        Mesh mesh;
        float top = 0, long_ = 0.31f, deep = 0.23f;
        for (int i = 0; i < books_; ++i) {
            const float t = dice.range(0.02f, 0.04f);
            append(mesh, book(t, long_, deep, bindingColour(dice), dice.unit() < 0.5f), 0,
                   placed({long_ / 2 + dice.range(-0.01f, 0.01f), top + t / 2, dice.range(-0.01f, 0.01f)}, {0, 0, 90}) *
                       placed({0, 0, 0}));
            top += t + 0.0005f;
            long_ *= dice.range(0.86f, 0.98f), deep *= dice.range(0.86f, 0.98f);
        }
        return onePart(std::move(mesh), bookSlots());
    }

private:
    int books_ = 3, seed_ = 1;
};

}  // namespace

std::unique_ptr<Procedural> makeBookshelf() { return std::make_unique<Bookshelf>(); }
std::unique_ptr<Procedural> makeBookStack() { return std::make_unique<BookStack>(); }

}  // namespace lumi
