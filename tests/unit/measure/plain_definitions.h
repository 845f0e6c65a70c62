#pragma once
#include <vector>

#include "measure/measure.h"

namespace lumi::plain {

/// The metrics once more, from their papers: double precision, loops over whole windows, nothing shared with renderer/.

/// A channel in double precision; outside it the nearest pixel counts.
struct Plane {
    int width = 0, height = 0;
    std::vector<double> values;

    Plane(int w, int h) : width(w), height(h), values(static_cast<size_t>(w) * static_cast<size_t>(h)) {}
    double& at(int x, int y) {
        return values[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)];
    }
    double at(int x, int y) const {
        return values[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)];
    }
    double near(int x, int y) const;
};

/// A prepared pair's value, and what its map shows.
struct Result {
    double value = 0;
    Plane map{0, 0};
};

Result rmse(const ImagePair& pair);
Result relmse(const ImagePair& pair);
Result mse(const ImagePair& pair);
Result mae(const ImagePair& pair);
Result psnr(const ImagePair& pair);
Result smape(const ImagePair& pair);
Result ssim(const ImagePair& pair);
Result msSsim(const ImagePair& pair);
Result flip(const ImagePair& pair);
Result hdrFlip(const ImagePair& pair);
Result cpbd(const ImagePair& pair);

}  // namespace lumi::plain
