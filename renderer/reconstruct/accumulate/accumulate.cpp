#include "reconstruct/accumulate/accumulate.h"

#include <cassert>
#include <cmath>

#include "base/parallel.h"

namespace lumi {
namespace {

constexpr int64_t kGrain = 1 << 14;

/// Joins the moments of two sets of samples [Chan 1979]: squares of (a and b together) about their common mean.
/// `na` and `nb` are the sets' sizes, neither 0.
struct JoinMoments {
    double na, nb;
    double operator()(double sumA, double squaresA, double sumB, double squaresB) const {
        const double difference = sumB / nb - sumA / na;
        return squaresA + squaresB + difference * difference * (na * nb / (na + nb));
    }
};

/// Squared deviations within one frame, from the frame's unbiased variance of one sample.
double squaresWithin(float sampleVariance, double samples) {
    return static_cast<double>(sampleVariance) * (samples - 1);
}

}  // namespace

AccumulateModule::AccumulateModule()
    : taps_{{.name = "sampleCount", .channels = "Y", .unit = "spp", .help = "Samples in the mean"},
            {.name = "standardError",
             .channels = "RGB",
             .unit = "W/(m^2 sr)",
             .colourMap = "magma",
             .help = "Standard error of the mean, as if samples were independent (Sobol's are better than that); 0 "
                     "before the second sample"}} {}

void AccumulateModule::describe(ParameterVisitor& v) {
    v.toggle("limit", limited_,
             {.label = "Stop at a number of samples", .help = "Whether the mean stops growing at max-samples"});
    v.when(limited_, [&] {
        v.integer(
            "max-samples", maxSamples_,
            {.label = "Samples to stop at",
             .min = 1,
             .max = 1 << 20,
             .scale = Scale::Log,
             .unit = "spp",
             .help = "The mean is complete with the frame that reaches this many samples a pixel; one that has more "
                     "already is complete, and keeps them until it starts again"});
    });
    v.choice("reset", reset_,
             {.label = "Start again on",
              .options = {"any-change", "cut-only"},
              .help = "Which changes begin a new mean: any of camera, objects, lights, materials and sampling, or only "
                      "cuts, so that everything that moves is averaged into a blur",
              .redo = Redo::History});
}

void AccumulateModule::resize(Extent2 extent) {
    extent_ = extent;
    forget();
}

void AccumulateModule::forget() {
    blocks_.clear();
    history_ = {};
    last_ = {};
    sampleCount_ = {};
    standardError_ = {};
}

bool AccumulateModule::resets(const Changes& changes) const {
    return reset_ == Reset::CutOnly ? changes.cut : changes.any();
}

Convergence AccumulateModule::convergence() const {
    const uint64_t before = last_.reset ? 0 : history_.samples;
    return {before + (last_.counted ? last_.samples : 0), limited_ ? static_cast<uint64_t>(maxSamples_) : 0};
}

RunResult AccumulateModule::run(const FrameContext& context, Image& out) {
    assert(context.signals.extent() == extent_ && extent_ == context.signals.noisySum().extent());
    if (context.stop.stop_requested()) return RunResult::Stopped;
    const auto measured = context.timer.measure("mean");

    // The history advances when the next frame comes, never before.
    if (context.frame != last_.frame) commitLastStep();
    last_.frame = context.frame;
    last_.samples = static_cast<uint64_t>(context.signals.samplesPerPixel());
    last_.reset = resets(context.changes) || history_.samples == 0;
    last_.counted = last_.reset || !limited_ || history_.samples < static_cast<uint64_t>(maxSamples_);
    last_.sum = context.signals.noisySum();
    last_.sampleVariance = context.signals[Signal::SampleVariance];

    out.reset(extent_, 3);
    const double samples = static_cast<double>(convergence().samples);
    if (last_.reset) ImageBlockSum().scaledTotal(last_.sum, 1 / samples, out);
    else if (last_.counted) blocks_.scaledTotal(last_.sum, 1 / samples, out);
    else blocks_.scaledTotal(ImageOf<double>(extent_, 3), 1 / samples, out);
    writeTaps(context.wantedTaps);
    return RunResult::Completed;
}

void AccumulateModule::commitLastStep() {
    if (last_.frame < 0) return;
    if (last_.reset) {
        blocks_.clear();
        history_ = {};
    }
    if (!last_.counted) return;
    const double n = static_cast<double>(last_.samples);
    if (history_.samples == 0) {
        history_.sum = last_.sum;
        history_.squares.reset(extent_, 3);
        for (size_t i = 0; i < history_.squares.size(); ++i)
            history_.squares.data()[i] = squaresWithin(last_.sampleVariance.data()[i], n);
    } else {
        const JoinMoments join{static_cast<double>(history_.samples), n};
        parallelRanges(static_cast<int64_t>(history_.sum.size()), kGrain, [&](int64_t begin, int64_t end) {
            for (int64_t i = begin; i < end; ++i) {
                double& sum = history_.sum.data()[i];
                double& squares = history_.squares.data()[i];
                const double stepSum = last_.sum.data()[i];
                squares = join(sum, squares, stepSum, squaresWithin(last_.sampleVariance.data()[i], n));
                sum += stepSum;
            }
        });
    }
    history_.samples += last_.samples;
    blocks_.add(static_cast<uint64_t>(last_.frame), 1, std::move(last_.sum));
}

void AccumulateModule::writeTaps(const TapSet& wanted) {
    sampleCount_ = {};
    standardError_ = {};
    if (wanted.count("sampleCount")) {
        sampleCount_.reset(extent_, 1);
        sampleCount_.fill(static_cast<float>(convergence().samples));
    }
    if (wanted.count("standardError")) writeStandardError();
}

void AccumulateModule::writeStandardError() {
    standardError_.reset(extent_, 3);
    const double before = last_.reset ? 0 : static_cast<double>(history_.samples);
    const double n = last_.counted ? static_cast<double>(last_.samples) : 0;
    if (before + n < 2) return;
    const JoinMoments join{before, n};
    parallelRanges(static_cast<int64_t>(standardError_.size()), kGrain, [&](int64_t begin, int64_t end) {
        for (int64_t i = begin; i < end; ++i) {
            const double within = squaresWithin(last_.sampleVariance.data()[i], n);
            double squares = within;
            if (n == 0) squares = history_.squares.data()[i];
            else if (before > 0)
                squares = join(history_.sum.data()[i], history_.squares.data()[i], last_.sum.data()[i], within);
            standardError_.data()[i] = static_cast<float>(std::sqrt(squares / ((before + n - 1) * (before + n))));
        }
    });
}

const Image& AccumulateModule::tap(const std::string& name) const {
    if (name == "sampleCount") return sampleCount_;
    if (name == "standardError") return standardError_;
    return Module::tap(name);
}

size_t AccumulateModule::byteCount() const {
    return blocks_.bytes() + history_.sum.bytes() + history_.squares.bytes() + last_.sum.bytes() +
           last_.sampleVariance.bytes() + sampleCount_.bytes() + standardError_.bytes();
}

}  // namespace lumi
