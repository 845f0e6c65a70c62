#include <cmath>
#include <map>
#include <tuple>

#include "image/exr.h"
#include "study/summary.h"

namespace lumi {
namespace {

/// What the images of all seeds of one frame say: each seed's mean squared error, the squared mean error of all of
/// them, and of all but one. Over the pixels that are finite in every image and in the reference: a pixel that is
/// missing in one seed would otherwise count as one without error.
struct FrameErrors {
    std::vector<double> squared;
    double squaredMean = 0;
    std::vector<double> squaredMeanWithout;
    int64_t counted = 0, leftOut = 0;  ///< pixels
};

Image readColour(const std::filesystem::path& path) { return readExr(path).image("", "RGB"); }

bool isFinite(const Image& image, size_t pixel) {
    const size_t area = static_cast<size_t>(image.extent().area());
    return std::isfinite(image.data()[pixel]) && std::isfinite(image.data()[pixel + area]) &&
           std::isfinite(image.data()[pixel + 2 * area]);
}

/// Adds one channel of one pixel.
void addDifferences(const std::vector<Image>& images, double reference, size_t at, FrameErrors& errors) {
    const size_t seeds = images.size();
    const auto difference = [&](size_t k) { return double(images[k].data()[at]) - reference; };
    double sum = 0;
    for (size_t k = 0; k < seeds; ++k) {
        sum += difference(k);
        errors.squared[k] += difference(k) * difference(k);
    }
    const double mean = sum / static_cast<double>(seeds);
    errors.squaredMean += mean * mean;
    if (seeds < 3) return;
    for (size_t k = 0; k < seeds; ++k) {
        const double others = (sum - difference(k)) / static_cast<double>(seeds - 1);
        errors.squaredMeanWithout[k] += others * others;
    }
}

FrameErrors errorsOf(const std::vector<Image>& images, const Image& reference) {
    const size_t seeds = images.size(), area = static_cast<size_t>(reference.extent().area());
    FrameErrors errors{std::vector<double>(seeds), 0, std::vector<double>(seeds)};
    for (size_t pixel = 0; pixel < area; ++pixel) {
        bool finite = isFinite(reference, pixel);
        for (const Image& image : images) finite = finite && isFinite(image, pixel);
        ++(finite ? errors.counted : errors.leftOut);
        for (size_t channel = 0; channel < 3 && finite; ++channel) {
            const size_t at = channel * area + pixel;
            addDifferences(images, double(reference.data()[at]), at, errors);
        }
    }
    // none: everything comes out NaN, which is no value
    const double count = 3.0 * static_cast<double>(errors.counted);
    errors.squaredMean /= count;
    for (size_t k = 0; k < seeds; ++k) errors.squared[k] /= count, errors.squaredMeanWithout[k] /= count;
    return errors;
}

/// The parts as they are without one of the seeds.
BiasVariance withoutSeed(const FrameErrors& errors, size_t k, double noise) {
    std::vector<double> others = errors.squared;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
    return separateBias(others, errors.squaredMeanWithout[k], noise);
}

void addShare(BiasVariance& sum, const BiasVariance& parts, double share) {
    sum.meanSquaredError += parts.meanSquaredError * share;
    sum.squaredBias += parts.squaredBias * share;
    sum.variance += parts.variance * share;
}

double biasShare(const BiasVariance& parts) {
    return parts.meanSquaredError > 0 ? parts.squaredBias / parts.meanSquaredError : std::nan("");
}

void findIntervals(const Study& study, const std::vector<double>& squared, const std::vector<BiasVariance>& without,
                   StudyBias& bias) {
    const auto jackknife = [&](double all, auto&& of) {
        std::vector<double> others;
        for (const BiasVariance& parts : without) others.push_back(of(parts));
        return meanInterval(pseudoValues(all, others), study.intervals.level, intervalMethod(study));
    };
    bias.meanSquaredError = meanInterval(squared, study.intervals.level, intervalMethod(study));
    bias.squaredBias = jackknife(bias.parts.squaredBias, [](const BiasVariance& parts) { return parts.squaredBias; });
    bias.variance = jackknife(bias.parts.variance, [](const BiasVariance& parts) { return parts.variance; });
    bias.share = jackknife(biasShare(bias.parts), biasShare);
}

}  // namespace

std::vector<StudyBias> separateBiases(const Study& study, const StudyPlan& plan, const StudyRecords& records) {
    using Key = std::tuple<size_t, size_t, int>;  // scene, method, samples
    std::map<Key, std::map<int64_t, std::vector<const StudyRow*>>> groups;
    for (const StudyRow& row : records.rows)
        if (row.frame >= 0 && row.method < plan.methods.size())
            groups[{row.scene, row.method, row.spp}][row.frame].push_back(&row);

    std::vector<StudyBias> biases;
    for (const auto& [key, frames] : groups) {
        StudyBias bias;
        bias.scene = std::get<0>(key), bias.method = std::get<1>(key), bias.spp = std::get<2>(key);
        const size_t seeds = frames.begin()->second.size();
        const double share = 1 / static_cast<double>(frames.size());
        std::vector<double> squared(seeds);
        std::vector<BiasVariance> without(seeds < 3 ? 0 : seeds);
        for (const auto& [frame, rows] : frames) {
            std::vector<Image> images;
            for (const StudyRow* row : rows) images.push_back(readColour(row->image));
            double noise = 0;
            for (const StudyReferenceNote& note : records.references)
                if (rows.front()->reference.filename() == std::filesystem::path(note.file).filename())
                    noise = note.floor.at("mse");
            const FrameErrors errors = errorsOf(images, readColour(rows.front()->reference));
            addShare(bias.parts, separateBias(errors.squared, errors.squaredMean, noise), share);
            for (size_t k = 0; k < seeds; ++k) squared[k] += (errors.squared[k] - noise) * share;
            for (size_t k = 0; k < without.size(); ++k) addShare(without[k], withoutSeed(errors, k, noise), share);
            bias.pixels += errors.counted, bias.pixelsLeftOut += errors.leftOut;
        }
        bias.seeds = static_cast<int>(seeds);
        bias.biasShare = biasShare(bias.parts);
        findIntervals(study, squared, without, bias);
        biases.push_back(std::move(bias));
    }
    return biases;
}

}  // namespace lumi
