#include <cmath>

#include "math/colour.h"
#include "scene/procedural/primitives.h"

namespace lumi {
namespace {

class Checker : public ProceduralTexture {
public:
    void describe(ParameterVisitor& v) override {
        v.colour("first", first_, {.label = "First colour", .help = "Linear colour of the square at the top left."});
        v.colour("second", second_, {.label = "Second colour", .help = "Linear colour of its neighbours."});
        v.integer("squares", squares_,
                  {.label = "Squares",
                   .min = 1,
                   .max = 64,
                   .help = "Pairs of squares along each side of the unit of uv.",
                   .redo = Redo::Build});
    }
    TextureImage build() const override {
        const int texels = 16, side = 2 * squares_ * texels;
        TextureImage image;
        image.name = "checker";
        image.srgb = true;
        image.levels.push_back({{side, side}, std::vector<uint8_t>(static_cast<size_t>(side * side) * 4), {}});
        uint8_t* out = image.levels[0].bytes.data();
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x, out += 4) {
                const Vec3 encoded = srgbFromLinear((x / texels + y / texels) % 2 == 0 ? first_ : second_);
                for (int c = 0; c < 3; ++c) out[c] = static_cast<uint8_t>(std::lround(255 * encoded[c]));
                out[3] = 255;
            }
        return image;
    }

private:
    Vec3 first_{0.7f}, second_{0.12f};
    int squares_ = 4;
};

}  // namespace

std::unique_ptr<ProceduralTexture> makeChecker() { return std::make_unique<Checker>(); }

}  // namespace lumi
