#pragma once
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "image/image.h"

namespace lumi {

/// Exposures of HDR-FLIP, in EV, evenly spaced from start to stop.
struct FlipExposures {
    double start = 0, stop = 0;
    int count = 2;

    /// As many exposures as the range has whole stops, two at least [Andersson 2021, eq. 4].
    static FlipExposures over(double start, double stop);
    bool operator==(const FlipExposures&) const = default;
};

/// What metrics can be told beside the images; each is printed with its number (Measurement::details). Command line
/// and study files fill the same fields.
struct MetricSettings {
    double relMseEpsilon = 0.001;  ///< added to the squared gray reference; above 0
    /// Of HDR-FLIP; without them it takes flipExposures(reference). All tests of one reference want the same.
    std::optional<FlipExposures> flipExposures{};

    bool operator==(const MetricSettings&) const = default;
};

/// Two images to compare: linear RGB of one extent. Pixels that are not finite in either image, or that a mask leaves
/// out, do not count in any metric; they are 0 in error maps.
struct ImagePair {
    Image image{}, reference{};  ///< 3 channels
    Image mask{};                ///< 1 channel, above 0.5 counts; empty: everything counts
    float exposureEv = 0;        ///< for metrics on tone-mapped images: 2^EV, clamp, sRGB
    MetricSettings settings{};

    /// Checks extents, finds non-finite pixels and blanks them: where the reference is broken both images get 0, where
    /// the image alone is it gets the reference's value, so that what is computed from the reference is the same for
    /// every image. Call once before measuring. Throws Error(BadInput) if extents differ.
    void prepare(const std::string& where = "");
    bool counts(int x, int y) const { return valid.empty() || valid.at(0, x, y) > 0.5f; }
    /// Why no pixel counts, as a sentence's end; empty if one does.
    std::string whyNothingCounts() const;

    /// Set by prepare(): pixels that are not finite in the image, in the reference, in the two together, and what
    /// counts.
    int64_t nonFiniteImage = 0, nonFiniteReference = 0, nonFinitePixels = 0, countedPixels = 0;
    Image valid{};  ///< set by prepare() where not everything counts
};

/// A metric's number and its error map (1 channel, extent of the images; empty if not asked for or not defined).
struct Measurement {
    /// NaN where there is none: nothing counts, the images are too small. Never 0 instead.
    double value = std::numeric_limits<double>::quiet_NaN();
    Image map{};
    /// Further values worth printing, e.g. HDR-FLIP's exposure range: name and number.
    std::vector<std::pair<std::string, double>> details{};
    std::string reason{};  ///< why `value` is NaN or infinite; empty where it is a number
};

/// One metric the program knows.
struct Metric {
    const char* id;  ///< "rel_mse" style ids of `list metrics`
    const char* title;
    const char* definition;  ///< one sentence with space, constants and source
    bool higherIsBetter;
    bool symmetric;          ///< measure(a, b) == measure(b, a)
    const char* mapColours;  ///< colour map for its error map, nullptr without one
    bool unitMap;            ///< its map goes from 0, no difference, to 1, a complete one
    Measurement (*measure)(const ImagePair& pair, bool wantMap);
    const char* range;   ///< interval of its values: "[0, 1]"
    const char* source;  ///< the paper's key in the README, or the field's usual definition
};

/// Every metric, in the order of the contract: rmse relmse mse mae psnr smape ssim ms_ssim flip hdr_flip cpbd.
const std::vector<Metric>& metricCatalog();
/// Throws Error(Usage) naming the nearest id, of a metric of images or of sequences.
const Metric& findMetric(const std::string& id, const std::string& where = "");

/// Tone-mapped image as metrics on LDR see it: exposure, clamp to [0,1], sRGB encoding; 3 channels.
Image ldrImage(const Image& linear, float exposureEv);

/// Sets a map to 0 in pixels that do not count.
void clearUncounted(Image& map, const ImagePair& pair);

/// Mean of a map over the pixels that count, summed in double, row by row; NaN if none does.
double meanOverMask(const Image& map, const ImagePair& pair);

/// The map's mean as a measurement, with the map if it is wanted and the reason if nothing counts.
Measurement meanMeasurement(Image map, const ImagePair& pair, bool wantMap);

}  // namespace lumi
