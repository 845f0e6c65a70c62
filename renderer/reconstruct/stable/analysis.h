#pragma once
#include <stop_token>
#include <vector>

#include "params/parameter.h"
#include "reconstruct/stable/sample_set.h"

namespace lumi {

/// How many samples there shall be [DalCorso17, sec. 4.2].
struct DensitySettings {
    float density = 1;        ///< d_target, visible samples a pixel
    float tolerance = 0.75f;  ///< d_tolerance
    float jitter = 0.5f;      ///< how far new samples lie off the middle of their stratum

    void describe(ParameterVisitor& v);
};

/// Local density d = N/A: N visible samples in the 2 x 2 pixels centred on the pixel (8 x 8 sub-pixels, of it and its
/// eight neighbours), A the part of these that lies in the image.
float localDensity(const std::vector<uint32_t>& words, Extent2 extent, int x, int y);

/// Eq. 1: how many samples to add, or to remove where it is negative. It acts where |d_target - d| = d_tolerance too,
/// or an empty screen would stay empty at 1 and 1; for the same reason the tolerance counts as d_target at most.
int sampleChange(float density, const DensitySettings& settings);

/// What the analysis decides for one pixel.
struct PixelChange {
    uint16_t added = 0;    ///< sub-pixels that get a new sample; occluded ones there go
    uint16_t removed = 0;  ///< sub-pixels whose visible sample goes
};

/// Spends `change` (eq. 1) in a pixel: adds to the stratum with the fewest visible samples and removes from that with
/// the most, ties drawn by `random`. A new sample takes a free sub-pixel of its stratum, or else that of an occluded
/// sample; where there is neither, none is added.
PixelChange changePixel(uint32_t word, int change, uint32_t random);

/// Where a new sample lies within its pixel: in the middle of its stratum, moved into its sub-pixel by a random offset
/// of up to `jitter` sub-pixels.
Vec2 newSamplePlace(int subpixel, float jitter, uint32_t random);

/// The changes of all pixels, each decided from the words as they are. `density` (may be null) receives d. Returns
/// whether any pixel changes.
bool analyseSamples(const std::vector<uint32_t>& words, Extent2 extent, const DensitySettings& settings, uint32_t frame,
                    std::vector<PixelChange>& changes, float* density, std::stop_token stop);

/// The random word of a pixel in a frame.
uint32_t pixelRandom(int64_t pixel, uint32_t frame);

}  // namespace lumi
