#include "math/colour.h"

#include <array>

namespace lumi {

const float* linearFromSrgbTable() {
    static const std::array<float, 256> table = [] {
        std::array<float, 256> values{};
        for (int i = 0; i < 256; ++i) values[static_cast<size_t>(i)] = linearFromSrgb(static_cast<float>(i) / 255.0f);
        return values;
    }();
    return table.data();
}

}  // namespace lumi
