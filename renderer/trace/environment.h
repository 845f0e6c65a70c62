#pragma once
#include <array>
#include <memory>
#include <vector>

#include "scene/light.h"
#include "trace/light_lanes.h"

namespace lumi {

/// Light from infinitely far, ready to be looked up and sampled: a constant, or an equirectangular image that is
/// interpolated bilinearly and sampled by rows and columns of a piecewise-constant density [Pharr 2016, section 14.2].
/// The density of a cell counts the texels around it, so that every direction with light can be drawn.
class EnvironmentLight {
public:
    /// Keeps the tables if the image is the one of the last build.
    void build(const Environment& environment);

    bool black() const { return black_; }
    /// Radiance from unit world direction `direction`.
    Vec3 radiance(const Vec3& direction) const;
    /// A direction with light, its density per solid angle and its place in the image.
    Vec3 sample(Vec2 u, float& pdf, Vec2& place) const;
    Vec3 radianceAt(Vec2 place) const { return image_ ? imageRadiance(place) : constant_; }
    /// Asks the caches for what radianceAt() will read.
    void prefetch(Vec2 place) const {
        if (!image_) return;
        const auto x = static_cast<size_t>(place.x * static_cast<float>(width_ - 1));
        const auto y = static_cast<size_t>(place.y * static_cast<float>(height_ - 1));
        __builtin_prefetch(&texels_[y * static_cast<size_t>(width_) + x]);
        if (y > 0) __builtin_prefetch(&texels_[(y - 1) * static_cast<size_t>(width_) + x]);
    }
    float pdf(const Vec3& direction) const;
    bool hasImage() const { return image_ != nullptr; }
    /// The cell of the image's grid that u draws, and the bounds of the numbers that draw it.
    struct Cell {
        int column = 0, row = 0;
        float columnLow = 0, columnHigh = 1, rowLow = 0, rowHigh = 1;
    };
    Cell cellAt(Vec2 u) const;
    SkyGrid grid() const { return {static_cast<float>(columns_), static_cast<float>(rows_), cos_, sin_}; }
    /// Mean over the sphere of the luminance.
    float meanLuminance() const { return meanLuminance_; }
    /// About the luminance of the irradiance on a plane with unit world normal `normal`, W/m^2: exact along the image's
    /// axes, squares of the normal's components between them ["ambient cube", Mitchell et al. 2006].
    float irradiance(const Vec3& normal) const;
    /// What irradiance() reads, for a sky that counts at least as `least`.
    SkyCube cube(float least) const;
    size_t byteCount() const {
        return (rowCdf_.size() + columnCdf_.size()) * sizeof(float) + texels_.size() * sizeof(Vec3) +
               (rowGuide_.size() + columnGuide_.size()) * sizeof(uint16_t);
    }

private:
    void buildTexels(const Image& image);
    struct Grid;
    Grid finestGrid() const;
    double texelLuminance(int x, int y) const;
    double texelMeanLuminance() const;  ///< over the sphere, scale left out
    void buildTables();
    void buildAmbientCube(const Grid& grid, double cell);
    Vec3 imageRadiance(Vec2 uv) const;
    Vec3 toImage(const Vec3& world) const {
        return {cos_ * world.x - sin_ * world.z, world.y, sin_ * world.x + cos_ * world.z};
    }
    Vec3 toWorld(const Vec3& d) const { return {cos_ * d.x + sin_ * d.z, d.y, -sin_ * d.x + cos_ * d.z}; }
    float density(int column, int row) const;  ///< per unit square of the image

    std::shared_ptr<const Image> image_;
    Vec3 constant_{0};
    float scale_ = 1, cos_ = 1, sin_ = 0;
    bool black_ = true;
    float imageMeanLuminance_ = 0, meanLuminance_ = 0;
    std::array<float, 6> ambient_{};  ///< irradiance along +X, -X, +Y, -Y, +Z, -Z of the image, scale left out
    int columns_ = 0, rows_ = 0;
    int width_ = 0, height_ = 0;
    std::vector<Vec3> texels_;                      ///< the image, interleaved
    std::vector<float> rowCdf_;                     ///< rows_ + 1, ends at 1
    std::vector<float> columnCdf_;                  ///< rows_ times columns_ + 1, each row ends at 1
    std::vector<uint16_t> rowGuide_, columnGuide_;  ///< where to start looking in the tables [Chen & Asau 1974]
};

}  // namespace lumi
