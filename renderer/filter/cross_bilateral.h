#pragma once
#include <array>
#include <stop_token>
#include <vector>

#include "filter/cross_bilateral_kernels.h"
#include "frame/signals.h"

namespace lumi {

/// A bank of cross-bilateral filters and the choice among them by Stein's unbiased risk estimate [Li12]:
///
///     w(p,q) = exp(-|p-q|^2 / 2 sigma_s^2) exp(-|c_p-c_q|^2 / 2 sigma_r^2) prod_k exp(-|f_p-f_q|^2 / 2 sigma_k^2)
///
/// for sigma_s of 1, 2, 4 and 8 pixels over windows of two sigmas. Features are normal, albedo and depth, all free of
/// noise, so that their distances are not normalised by a variance ([Schied17, sec. 5.1] runs it so).
struct SureSettings {
    float sigmaColour = 2;  ///< of sigma_r, in standard deviations of a pixel
    float sigmaNormal = 0.8f;
    float sigmaAlbedo = 0.25f;
    float sigmaDepth = 0.05f;  ///< of the depth
    int varianceRadius = 3;    ///< window that the variance of a pixel's colour is estimated in
    int filters = 4;           ///< of the bank, beginning with the narrowest
};

/// Buffers of chooseBySure(), kept from frame to frame for their memory, and to be looked at.
struct SureBank {
    Image variance;                                        ///< Y, of a pixel's channels, their mean
    std::array<Image, CrossBilateralRow::kMost> filtered;  ///< RGB
    std::array<Image, CrossBilateralRow::kMost> error;     ///< Y, estimated squared error, as found
    Image choice;  ///< Y, the filter that is taken, between filters where neighbours differ
    Image scratch;
    size_t bytes() const;
};

/// What it reads beside its input.
inline SignalSet sureSignals() { return {Signal::Normal, Signal::InverseDepth}; }

/// Filters `in` (RGB) into `out` (RGB; not `in`). The errors are smoothed before the least is chosen, and the choice is
/// smoothed before the filters are blended by it [Li12, sec. 4.3]. `albedo` RGB. Returns false if stopped.
bool chooseBySure(const Signals& signals, const Image& albedo, const SureSettings& settings, const Image& in,
                  SureBank& bank, Image& out, std::stop_token stop);

}  // namespace lumi
