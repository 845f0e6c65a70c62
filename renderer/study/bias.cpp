#include <cmath>
#include <map>
#include <tuple>

#include "image/exr.h"
#include "study/summary.h"

namespace lumi {
namespace {

/// What the images of all seeds of one frame say: each seed's mean squared error, the squared mean error of all of them,
/// and of all but one.
struct FrameErrors {
    std::vector<double> squared;
    double squaredMean = 0;
    std::vector<double> squaredMeanWithout;
};

Image readColour(const std::filesystem::path& path) { return readExr(path).image("", "RGB"); }

/// Pixels that are not finite in any image count as 0 error, as they do in the metrics.
FrameErrors errorsOf(const std::vector<Image>& images, const Image& reference) {
    const size_t seeds = images.size();
    FrameErrors errors{std::vector<double>(seeds), 0, std::vector<double>(seeds)};
    std::vector<double> differences(seeds);
    for (size_t i = 0; i < reference.size(); ++i) {
        double sum = 0;
        for (size_t k = 0; k < seeds; ++k) {
            const double difference = double(images[k].data()[i]) - double(reference.data()[i]);
            differences[k] = std::isfinite(difference) ? difference : 0;
            sum += differences[k];
            errors.squared[k] += differences[k] * differences[k];
        }
        const double mean = sum / static_cast<double>(seeds);
        errors.squaredMean += mean * mean;
        if (seeds < 3) continue;
        for (size_t k = 0; k < seeds; ++k) {
            const double others = (sum - differences[k]) / static_cast<double>(seeds - 1);
            errors.squaredMeanWithout[k] += others * others;
        }
    }
    const double count = static_cast<double>(reference.size());
    errors.squaredMean /= count;
    for (size_t k = 0; k < seeds; ++k) errors.squared[k] /= count, errors.squaredMeanWithout[k] /= count;
    return errors;
}

/// Pseudo-values of the squared bias, a seed each [Quenouille 1956]; none for fewer than three seeds.
std::vector<double> pseudoValues(const FrameErrors& errors, double noise) {
    const size_t seeds = errors.squared.size();
    if (seeds < 3) return {};
    const double n = static_cast<double>(seeds), all = separateBias(errors.squared, errors.squaredMean, noise).squaredBias;
    std::vector<double> values;
    for (size_t k = 0; k < seeds; ++k) {
        std::vector<double> others;
        for (size_t j = 0; j < seeds; ++j)
            if (j != k) others.push_back(errors.squared[j]);
        values.push_back(n * all - (n - 1) * separateBias(others, errors.squaredMeanWithout[k], noise).squaredBias);
    }
    return values;
}

void addTo(std::vector<double>& sums, const std::vector<double>& values) {
    sums.resize(values.size());
    for (size_t i = 0; i < values.size(); ++i) sums[i] += values[i];
}

}  // namespace

std::vector<StudyBias> separateBiases(const Study& study, const StudyPlan& plan, const StudyRecords& records) {
    using Key = std::tuple<size_t, size_t, int>;  // scene, method, samples
    std::map<Key, std::map<int64_t, std::vector<const StudyRow*>>> groups;
    for (const StudyRow& row : records.rows)
        if (row.frame >= 0) groups[{row.scene, row.method, row.spp}][row.frame].push_back(&row);

    std::vector<StudyBias> biases;
    for (const auto& [key, frames] : groups) {
        StudyBias bias{std::get<0>(key), std::get<1>(key), std::get<2>(key), 0, {}, {}, {}};
        std::vector<double> squared, pseudo;
        const double count = static_cast<double>(frames.size());
        for (const auto& [frame, rows] : frames) {
            std::vector<Image> images;
            for (const StudyRow* row : rows) images.push_back(readColour(row->image));
            double noise = 0;
            for (const StudyReferenceNote& note : records.references)
                if (rows.front()->reference.filename() == std::filesystem::path(note.file).filename()) noise = note.floor.at("mse");
            const FrameErrors errors = errorsOf(images, readColour(rows.front()->reference));
            const BiasVariance parts = separateBias(errors.squared, errors.squaredMean, noise);
            bias.seeds = static_cast<int>(rows.size());
            bias.parts.meanSquaredError += parts.meanSquaredError / count;
            bias.parts.squaredBias += parts.squaredBias / count;
            bias.parts.variance += parts.variance / count;
            std::vector<double> corrected = errors.squared;
            for (double& value : corrected) value = (value - noise) / count;
            addTo(squared, corrected);
            std::vector<double> values = pseudoValues(errors, noise);
            for (double& value : values) value /= count;
            addTo(pseudo, values);
        }
        bias.meanSquaredError = meanInterval(squared, study.intervals.level, intervalMethod(study));
        bias.squaredBias = meanInterval(pseudo, study.intervals.level, intervalMethod(study));
        biases.push_back(std::move(bias));
    }
    return biases;
}

}  // namespace lumi
