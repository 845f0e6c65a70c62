#include "trace/environment.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parallel.h"
#include "math/sin_cos.h"
#include "math/warp.h"

namespace lumi {
namespace {

/// The grid that directions are drawn from is at most this wide and half as high, and coarser where that costs little:
/// small tables stay in the cache.
constexpr int kMostColumns = 1024, kLeastColumns = 64;
/// How much the second moment of a light sample may grow by a coarser grid.
constexpr double kMostGrowth = 1.2;

/// The first whole number that is not below numerator / denominator.
int firstNotBelow(int64_t numerator, int64_t denominator) {
    return static_cast<int>((numerator + denominator - 1) / denominator);
}

/// Index i of the interval of an ascending table (count + 1 entries from 0 to 1) that holds u, never an empty one.
/// guide[k] is the interval that holds k / count.
int findInterval(const float* cdf, const uint16_t* guide, int count, float u) {
    int interval = guide[std::min(static_cast<int>(u * static_cast<float>(count)), count - 1)];
    while (interval < count - 1 && cdf[interval + 1] <= u) ++interval;
    while (interval > 0 && cdf[interval + 1] <= cdf[interval]) --interval;
    return interval;
}

void makeGuide(const float* cdf, int count, uint16_t* guide) {
    int interval = 0;
    for (int k = 0; k < count; ++k) {
        const float u = static_cast<float>(k) / static_cast<float>(count);
        while (interval < count - 1 && cdf[interval + 1] <= u) ++interval;
        guide[k] = static_cast<uint16_t>(interval);
    }
}

/// Running sums of `values` as a table from 0 to 1; a row without weight becomes uniform. Returns the sum.
double makeCdf(const float* values, int count, float* cdf) {
    double sum = 0;
    for (int i = 0; i < count; ++i) sum += values[i];
    double running = 0;
    cdf[0] = 0;
    for (int i = 0; i < count; ++i) {
        running += values[i];
        cdf[i + 1] =
            sum > 0 ? static_cast<float>(running / sum) : static_cast<float>(i + 1) / static_cast<float>(count);
    }
    cdf[count] = 1;
    return sum;
}

}  // namespace

void EnvironmentLight::build(const Environment& environment) {
    const bool sameImage = environment.image == image_ && (image_ == nullptr || columns_ > 0);
    image_ = environment.image;
    constant_ = environment.constant * environment.scale;
    scale_ = environment.scale;
    cos_ = std::cos(radians(environment.rotateDeg));
    sin_ = std::sin(radians(environment.rotateDeg));
    if (image_ && (image_->empty() || image_->channels() < 3)) image_ = nullptr;
    if (!image_) {
        rowCdf_ = {}, columnCdf_ = {}, rowGuide_ = {}, columnGuide_ = {}, texels_ = {};
        columns_ = rows_ = 0;
    } else if (!sameImage) {
        buildTexels(*image_);
        buildTables();
    }
    meanLuminance_ = image_ ? imageMeanLuminance_ * scale_ : luminance(constant_);
    black_ = !(meanLuminance_ > 0) || !std::isfinite(meanLuminance_);
}

void EnvironmentLight::buildTexels(const Image& image) {
    width_ = image.width(), height_ = image.height();
    texels_.resize(static_cast<size_t>(width_) * static_cast<size_t>(height_));
    parallelRanges(height_, 16, [&](int64_t begin, int64_t end) {
        for (int y = static_cast<int>(begin); y < end; ++y)
            for (int x = 0; x < width_; ++x)
                texels_[static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x)] =
                    Vec3(image.at(0, x, y), image.at(1, x, y), image.at(2, x, y));
    });
}

/// Importance of the cells of a grid over the image, in proportion to luminance and solid angle.
struct EnvironmentLight::Grid {
    int columns = 0, rows = 0;
    std::vector<double> weight, square;  ///< sums over a cell of the finest grid's weights and of their squares

    double& at(std::vector<double>& values, int column, int row) const {
        return values[static_cast<size_t>(row) * static_cast<size_t>(columns) + static_cast<size_t>(column)];
    }
    /// Second moment of the light found by sampling this grid, up to a factor: a cell's weight is spread evenly.
    double secondMoment() const {
        double sum = 0;
        for (size_t i = 0; i < weight.size(); ++i)
            if (weight[i] > 0) sum += square[i] / weight[i];
        return sum / static_cast<double>(weight.size());
    }
    Grid halved() const {
        Grid half{columns / 2, rows / 2, {}, {}};
        half.weight.assign(weight.size() / 4, 0);
        half.square.assign(weight.size() / 4, 0);
        for (int row = 0; row < rows; ++row)
            for (int column = 0; column < columns; ++column) {
                const auto from = static_cast<size_t>(row) * static_cast<size_t>(columns) + static_cast<size_t>(column);
                half.at(half.weight, column / 2, row / 2) += weight[from];
                half.at(half.square, column / 2, row / 2) += square[from];
            }
        return half;
    }
};

/// 0 where it is no number or infinite.
double EnvironmentLight::texelLuminance(int x, int y) const {
    const float value =
        luminance(texels_[static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x)]);
    return value > 0 && std::isfinite(value) ? double(value) : 0.0;
}

EnvironmentLight::Grid EnvironmentLight::finestGrid() const {
    Grid grid;
    grid.columns = std::min(width_, kMostColumns);
    grid.rows = std::min(height_, kMostColumns / 2);
    const size_t cells = static_cast<size_t>(grid.columns) * static_cast<size_t>(grid.rows);
    grid.weight.resize(cells), grid.square.resize(cells);
    const auto light = [&](int x, int y) {
        return texelLuminance((x + width_) % width_, std::clamp(y, 0, height_ - 1));
    };
    parallelRanges(grid.rows, 16, [&](int64_t begin, int64_t end) {
        for (int row = static_cast<int>(begin); row < end; ++row) {
            const int y0 = static_cast<int>(int64_t(row) * height_ / grid.rows);
            const int y1 = firstNotBelow(int64_t(row + 1) * height_, grid.rows);
            const double sine = std::sin(std::numbers::pi * (row + 0.5) / grid.rows);
            for (int column = 0; column < grid.columns; ++column) {
                const int x0 = static_cast<int>(int64_t(column) * width_ / grid.columns);
                const int x1 = firstNotBelow(int64_t(column + 1) * width_, grid.columns);
                // The cell's own texels, those on its edges among them, and with a small weight their neighbours, which
                // interpolation mixes in.
                double own = 0, around = 0;
                for (int y = y0 - 1; y <= y1; ++y)
                    for (int x = x0 - 1; x <= x1; ++x)
                        (y >= y0 && y < y1 && x >= x0 && x < x1 ? own : around) += light(x, y);
                const int count = (y1 - y0) * (x1 - x0), border = (y1 - y0 + 2) * (x1 - x0 + 2) - count;
                const double weight = sine * (0.75 * own / count + 0.25 * around / border);
                grid.at(grid.weight, column, row) = weight;
                grid.at(grid.square, column, row) = weight * weight;
            }
        }
    });
    return grid;
}

double EnvironmentLight::texelMeanLuminance() const {
    std::vector<double> rowLight(static_cast<size_t>(height_)), rowSine(rowLight.size());
    parallelRanges(height_, 16, [&](int64_t begin, int64_t end) {
        for (int y = static_cast<int>(begin); y < end; ++y) {
            const auto row = static_cast<size_t>(y);
            for (int x = 0; x < width_; ++x) rowLight[row] += texelLuminance(x, y);
            rowSine[row] = std::sin(std::numbers::pi * (y + 0.5) / height_);
            rowLight[row] *= rowSine[row];
        }
    });
    double light = 0, sines = 0;
    for (size_t row = 0; row < rowLight.size(); ++row) light += rowLight[row], sines += rowSine[row];
    return light / (sines * width_);
}

/// `cell` is the solid angle of a cell of the finest grid over the sine of its angle from +Y; weights hold that sine.
void EnvironmentLight::buildAmbientCube(const Grid& grid, double cell) {
    std::array<double, 6> sums{};
    for (int row = 0; row < grid.rows; ++row)
        for (int column = 0; column < grid.columns; ++column) {
            const Vec3 d =
                directionFromLatLong(Vec2((static_cast<float>(column) + 0.5f) / static_cast<float>(grid.columns),
                                          (static_cast<float>(row) + 0.5f) / static_cast<float>(grid.rows)));
            const double weight = grid.weight[static_cast<size_t>(row) * static_cast<size_t>(grid.columns) +
                                              static_cast<size_t>(column)] *
                                  cell;
            for (int axis = 0; axis < 3; ++axis)
                sums[static_cast<size_t>(2 * axis + (d[axis] < 0))] += weight * std::abs(d[axis]);
        }
    for (size_t side = 0; side < 6; ++side) ambient_[side] = static_cast<float>(sums[side]);
}

float EnvironmentLight::irradiance(const Vec3& normal) const {
    if (!image_) return kPi * meanLuminance_;
    const Vec3 n = toImage(normal);
    float sum = 0;
    for (int axis = 0; axis < 3; ++axis) sum += sqr(n[axis]) * ambient_[static_cast<size_t>(2 * axis + (n[axis] < 0))];
    return sum * scale_;
}

SkyCube EnvironmentLight::cube(float least) const {
    SkyCube cube;
    cube.least = least;
    for (size_t side = 0; side < 6; ++side) cube.side[side] = image_ ? ambient_[side] * scale_ : kPi * meanLuminance_;
    cube.cosine = cos_, cube.sine = sin_;
    return cube;
}

void EnvironmentLight::buildTables() {
    Grid grid = finestGrid();
    imageMeanLuminance_ = static_cast<float>(texelMeanLuminance());
    // Coarsen while the samples stay nearly as good.
    const double finest = grid.secondMoment();
    const double cell = 2 * double(kPi) * double(kPi) / static_cast<double>(grid.weight.size());
    while (grid.columns > kLeastColumns && grid.columns % 2 == 0 && grid.rows % 2 == 0) {
        Grid half = grid.halved();
        if (half.secondMoment() > kMostGrowth * finest) break;
        grid = std::move(half);
    }
    buildAmbientCube(grid, cell);
    columns_ = grid.columns;
    rows_ = grid.rows;
    const std::vector<float> weights(grid.weight.begin(), grid.weight.end());
    rowCdf_.assign(static_cast<size_t>(rows_) + 1, 0);
    columnCdf_.assign(static_cast<size_t>(rows_) * static_cast<size_t>(columns_ + 1), 0);
    rowGuide_.resize(static_cast<size_t>(rows_));
    columnGuide_.resize(weights.size());
    std::vector<float> rowWeights(static_cast<size_t>(rows_));
    for (int row = 0; row < rows_; ++row) {
        const auto r = static_cast<size_t>(row);
        rowWeights[r] = static_cast<float>(makeCdf(&weights[r * static_cast<size_t>(columns_)], columns_,
                                                   &columnCdf_[r * static_cast<size_t>(columns_ + 1)]));
        makeGuide(&columnCdf_[r * static_cast<size_t>(columns_ + 1)], columns_,
                  &columnGuide_[r * static_cast<size_t>(columns_)]);
    }
    makeCdf(rowWeights.data(), rows_, rowCdf_.data());
    makeGuide(rowCdf_.data(), rows_, rowGuide_.data());
}

Vec3 EnvironmentLight::radiance(const Vec3& direction) const {
    return image_ ? imageRadiance(latLongFromDirection(toImage(direction))) : constant_;
}

Vec3 EnvironmentLight::imageRadiance(Vec2 uv) const {
    // A direction that is no number looks up a texel too.
    const float fx = saturate(uv.x) * static_cast<float>(width_) + 0.5f,
                fy = saturate(uv.y) * static_cast<float>(height_) + 0.5f;
    // Texel centres are at halves: the pair around the point is (cell - 1, cell).
    const int cellX = static_cast<int>(fx), cellY = static_cast<int>(fy);
    const float tx = fx - static_cast<float>(cellX), ty = fy - static_cast<float>(cellY);
    const int x0 = cellX > 0 ? cellX - 1 : width_ - 1, x1 = cellX < width_ ? cellX : 0;
    const Vec3* top = &texels_[static_cast<size_t>(std::max(cellY - 1, 0)) * static_cast<size_t>(width_)];
    const Vec3* bottom = &texels_[static_cast<size_t>(std::min(cellY, height_ - 1)) * static_cast<size_t>(width_)];
    return ((top[x0] * (1 - tx) + top[x1] * tx) * (1 - ty) + (bottom[x0] * (1 - tx) + bottom[x1] * tx) * ty) * scale_;
}

float EnvironmentLight::density(int column, int row) const {
    const float* columnCdf = &columnCdf_[static_cast<size_t>(row) * static_cast<size_t>(columns_ + 1)];
    return (rowCdf_[static_cast<size_t>(row) + 1] - rowCdf_[static_cast<size_t>(row)]) *
           (columnCdf[column + 1] - columnCdf[column]) * static_cast<float>(rows_) * static_cast<float>(columns_);
}

EnvironmentLight::Cell EnvironmentLight::cellAt(Vec2 u) const {
    const int row = findInterval(rowCdf_.data(), rowGuide_.data(), rows_, u.y);
    const float* columnCdf = &columnCdf_[static_cast<size_t>(row) * static_cast<size_t>(columns_ + 1)];
    const int column =
        findInterval(columnCdf, &columnGuide_[static_cast<size_t>(row) * static_cast<size_t>(columns_)], columns_, u.x);
    const float* rowCdf = &rowCdf_[static_cast<size_t>(row)];
    return {column, row, columnCdf[column], columnCdf[column + 1], rowCdf[0], rowCdf[1]};
}

Vec3 EnvironmentLight::sample(Vec2 u, float& pdf, Vec2& place) const {
    if (!image_) {
        pdf = pdfSphere();
        place = Vec2(0);
        return sampleSphere(u);
    }
    const Cell cell = cellAt(u);
    const auto within = [](float low, float high, float value) {
        const float size = high - low;
        return size > 0 ? std::clamp((value - low) / size, 0.0f, 0x1.fffffep-1f) : 0.5f;
    };
    const Vec2 uv(
        (static_cast<float>(cell.column) + within(cell.columnLow, cell.columnHigh, u.x)) / static_cast<float>(columns_),
        (static_cast<float>(cell.row) + within(cell.rowLow, cell.rowHigh, u.y)) / static_cast<float>(rows_));
    const SinCos phi = sinCosTurns(uv.x - 0.5f), theta = sinCosTurns(0.5f * uv.y);
    pdf = theta.sine > 0 ? density(cell.column, cell.row) / (2 * kPi * kPi * theta.sine) : 0;
    place = uv;
    // directionFromLatLong(), the sine of theta taken along.
    return toWorld({theta.sine * phi.sine, theta.cosine, -theta.sine * phi.cosine});
}

float EnvironmentLight::pdf(const Vec3& direction) const {
    if (!image_) return pdfSphere();
    const Vec3 d = toImage(direction);
    const Vec2 uv = latLongFromDirection(d);
    const float sine = std::sqrt(std::max(0.0f, 1 - d.y * d.y));
    if (!(sine > 0)) return 0;
    const int column = std::min(static_cast<int>(saturate(uv.x) * static_cast<float>(columns_)), columns_ - 1);
    const int row = std::min(static_cast<int>(saturate(uv.y) * static_cast<float>(rows_)), rows_ - 1);
    return density(column, row) / (2 * kPi * kPi * sine);
}

}  // namespace lumi
