#pragma once
#include "measure/measure.h"

/// The metrics one by one; metricCatalog() gives their definitions. All want a prepared pair.
namespace lumi {

Measurement measureMse(const ImagePair& pair, bool wantMap);
Measurement measureRmse(const ImagePair& pair, bool wantMap);
Measurement measureMae(const ImagePair& pair, bool wantMap);
Measurement measurePsnr(const ImagePair& pair, bool wantMap);
Measurement measureRelMse(const ImagePair& pair, bool wantMap);
Measurement measureSmape(const ImagePair& pair, bool wantMap);
Measurement measureSsim(const ImagePair& pair, bool wantMap);
Measurement measureMsSsim(const ImagePair& pair, bool wantMap);
Measurement measureFlip(const ImagePair& pair, bool wantMap);
Measurement measureHdrFlip(const ImagePair& pair, bool wantMap);
Measurement measureCpbd(const ImagePair& pair, bool wantMap);

/// SSIM of LDR images in [0,1] [Wang 2004]: Gaussian window 11, sigma 1.5, windows fully inside, mean over channels.
double ssim(const Image& image, const Image& reference);
/// MS-SSIM [Wang 2003]: five scales with the standard weights; halving averages 2x2, odd sizes repeat their last row
/// and column. Images below 161 pixels on a side use as many scales as fit, weights renormalised.
double msSsim(const Image& image, const Image& reference);

/// Exposure range of HDR-FLIP from the reference [Andersson 2021, sec. 3.2] with the ACES tone mapper. A reference
/// whose median is 0 uses the median of its pixels above 0; an all-black one gives {0, 0}.
FlipExposures flipExposures(const Image& reference);

/// CPBD sharpness of one image, in [0,1], higher is sharper [Narvekar & Karam 2011], in whole grey levels as its
/// authors' program has it: vertical edges steeper than two levels a pixel, 0 where there is none. It differs in two
/// things: blocks that the border cuts count, and a block has edges if those are enough, where the program asks Canny's
/// detector. NaN below 3x3 pixels. `gray` in [0,255]. Only edges where `counted` (may be null) is above 0.5 count.
/// `map` (may be null) gets the probability that the blur of each edge that counts is noticed, 0 elsewhere; `edges`
/// (may be null) how many count.
double cpbd(ConstFloatPlane gray, const Image* counted = nullptr, Image* map = nullptr, int64_t* edges = nullptr);

}  // namespace lumi
