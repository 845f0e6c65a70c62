#include "reconstruct/supersampling/supersampling.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "base/memory.h"
#include "base/parallel.h"
#include "frame/motion.h"
#include "reconstruct/stable/sample_rays.h"
#include "trace/tracer.h"

namespace lumi {
namespace {

constexpr int kMost = 6;
/// Rows of the samples in the order of their columns.
constexpr int kRooks[kMost][kMost] = {{0}, {0, 1}, {1, 2, 0}, {1, 3, 0, 2}, {1, 3, 0, 4, 2}, {2, 5, 0, 3, 1, 4}};

/// Motion of the first surface of each path, by slot.
class MotionObserver : public PathObserver {
public:
    MotionObserver(const FrameContext& context, std::span<const uint32_t> samples, std::span<Vec2> motions)
        : context_(context), samples_(samples), motions_(motions) {}
    ObserverNeeds needs() const override { return {1, 0, 0, 0, false}; }
    void bounce(const BounceBatch& batch) override {
        const CameraPose &camera = context_.camera, &previous = context_.previousCamera;
        for (size_t i = 0; i < batch.slots.size(); ++i) {
            const PathVertex& v = batch.vertices[i];
            motions_[samples_[batch.slots[i]]] = Vec2(
                v.point.valid() ? surfaceMotion(camera, previous, v.position, context_.tracer.previousPosition(v.point))
                                : skyMotion(camera, previous, -v.wo));
        }
    }

private:
    const FrameContext& context_;
    std::span<const uint32_t> samples_;
    std::span<Vec2> motions_;
};

}  // namespace

SupersamplingModule::SupersamplingModule()
    : taps_({{.name = "reconstructed",
              .channels = "RGB",
              .unit = "W/(m^2 sr)",
              .colourMap = "none",
              .help = "The image before temporal integration"},
             {.name = "sampleMotion",
              .channels = "XY",
              .unit = "px",
              .colourMap = "motion",
              .help = "The longest motion among the pixel's samples, previous minus current place; 0 without temporal "
                      "integration"}}) {}

void SupersamplingModule::describe(ParameterVisitor& v) {
    v.integer("spp", samplesPerPixel_,
              {.label = "Samples", .min = 1, .max = kMost, .unit = "spp", .help = "Samples a pixel and frame"});
    scattered_.describe(v);
    temporal_.describe(v);
}

void SupersamplingModule::resize(Extent2 extent) {
    const uint64_t aPixel = 40 + static_cast<uint64_t>(samplesPerPixel_) * (2 * sizeof(Vec2) + sizeof(Vec3) + 8);
    checkMemory("the samples of supersampling", aPixel * static_cast<uint64_t>(extent.area()));
    extent_ = extent;
    listedSamples_ = 0;
    forget();
}

void SupersamplingModule::forget() {
    temporal_.forget();
    taps_.clear();
}

Vec2 SupersamplingModule::placeInPixel(int s, int count, Vec2 jitter) {
    const Vec2 place = (Vec2(s, kRooks[count - 1][s]) + 0.5f) / static_cast<float>(count) + jitter;
    return glm::min(place - glm::floor(place), Vec2(0.99999f));
}

/// What depends on the extent and the number of samples alone.
void SupersamplingModule::listSamples() {
    if (listedSamples_ == samplesPerPixel_) return;
    const auto spp = static_cast<uint32_t>(samplesPerPixel_);
    const auto pixels = static_cast<size_t>(extent_.area());
    first_.resize(pixels + 1);
    for (size_t p = 0; p <= pixels; ++p) first_[p] = static_cast<uint32_t>(p) * spp;
    places_.resize(pixels * spp), colours_.resize(pixels * spp), motions_.resize(pixels * spp);
    list_.make(extent_, [spp](const PixelRun& run, std::vector<uint32_t>& list) {
        for (uint32_t s = 0; s < spp; ++s)
            for (uint32_t p = run.pixel; p < run.pixel + run.count; ++p) list.push_back(p * spp + s);
    });
    listedSamples_ = samplesPerPixel_;
}

bool SupersamplingModule::trace(const FrameContext& context) {
    listSamples();
    const Vec2 jitter =
        temporal_.enabled() ? frameJitter(static_cast<uint64_t>(context.frame), context.sampling.seed) : Vec2(0);
    Vec2 within[kMost];
    for (int s = 0; s < samplesPerPixel_; ++s) within[s] = placeInPixel(s, samplesPerPixel_, jitter);
    const std::span<const uint32_t> list = list_.items();
    constexpr int64_t kPaths = 1024;
    parallelRanges(
        static_cast<int64_t>(list.size()), kPaths,
        [&](int64_t begin, int64_t end) {
            traceRun(context, list.subspan(static_cast<size_t>(begin), static_cast<size_t>(end - begin)), within);
        },
        context.stop);
    return !context.stop.stop_requested();
}

void SupersamplingModule::traceRun(const FrameContext& context, std::span<const uint32_t> samples, const Vec2* within) {
    const SampleRays rays(context.camera);
    const auto spp = static_cast<uint32_t>(samplesPerPixel_), width = static_cast<uint32_t>(extent_.width);
    std::vector<PathStart> starts(samples.size());
    std::vector<Vec3> radiance(samples.size());
    for (size_t k = 0; k < samples.size(); ++k) {
        const uint32_t pixel = samples[k] / spp, s = samples[k] % spp;
        places_[samples[k]] = Vec2(pixel % width, pixel / width) + within[s];
        starts[k] = rays.through(places_[samples[k]]);
        starts[k].key = {pixel % width, pixel / width, static_cast<uint32_t>(context.frame) * spp + s};
        starts[k].slot = static_cast<uint32_t>(k);
    }
    MotionObserver observer(context, samples, motions_);
    PathObserver* const observers[] = {&observer};
    const bool wantsMotion = temporal_.enabled();
    context.tracer.tracePaths(
        starts, context.sampling.path, context.sampling.seed, radiance,
        wantsMotion ? std::span<PathObserver* const>(observers) : std::span<PathObserver* const>(), context.stop);
    for (size_t k = 0; k < samples.size(); ++k) colours_[samples[k]] = radiance[k];
}

RunResult SupersamplingModule::run(const FrameContext& context, Image& out) {
    assert(context.camera.extent == extent_);
    if (context.stop.stop_requested()) return RunResult::Stopped;
    taps_.begin(context.wantedTaps);
    {
        const auto measured = context.timer.measure("shading");
        if (!trace(context)) return RunResult::Stopped;
    }
    {
        const auto measured = context.timer.measure("reconstruction");
        if (reconstructScattered({extent_, first_, places_, colours_, {}}, scattered_, out, weights_, context.stop) < 0)
            return RunResult::Stopped;
        if (motion_.extent() != extent_) motion_.reset(extent_, 2);
        if (temporal_.enabled()) longestMotions(first_, motions_, {}, motion_);
        else if (taps_.wants("sampleMotion")) motion_.fill(0);
    }
    taps_.keep("reconstructed", out);
    taps_.keep("sampleMotion", motion_);
    if (!temporal_.run(context, motion_, out)) return RunResult::Stopped;
    temporal_.commit();
    taps_.commit();
    return RunResult::Completed;
}

const Image& SupersamplingModule::tap(const std::string& name) const {
    const Image* found = taps_.find(name);
    return found ? *found : Module::tap(name);
}

size_t SupersamplingModule::byteCount() const {
    return first_.size() * 4 + list_.bytes() + places_.size() * (2 * sizeof(Vec2) + sizeof(Vec3)) + weights_.bytes() +
           motion_.bytes() + temporal_.bytes() + taps_.bytes();
}

}  // namespace lumi
