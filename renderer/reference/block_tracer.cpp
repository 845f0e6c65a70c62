#include "reference/block_tracer.h"

#include <utility>

#include "base/error.h"

namespace lumi {

bool BlockTracer::sample(SampleRange range, const SignalSet& wanted, Signals& signals, std::stop_token stop) {
    if (!bound_) {
        try {
            tracer_.bind(
                poseScene(spec_.scene, {spec_.time, spec_.time + spec_.openSeconds, spec_.time}, nullptr, stop), stop);
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::Interrupted) throw;
            return false;
        }
        bound_ = true;
    }
    FrameSampling sampling;
    sampling.extent = spec_.camera.extent;
    sampling.camera = sampling.previousCamera = spec_.camera;
    sampling.samplesPerPixel = static_cast<int>(range.count());
    sampling.firstSample = range.begin;
    sampling.seed = spec_.seed;
    sampling.jitter = spec_.jitter;
    sampling.path = spec_.path;
    sampling.shutterOpen = spec_.camera.shutter > 0;
    sampling.cameraTrack = sampling.previousCameraTrack = spec_.cameraTrack;
    sampling.wanted = wanted;
    return tracer_.sample(sampling, signals, stop);
}

bool BlockTracer::traceSum(SampleRange range, ImageOf<double>& out, std::stop_token stop) {
    Signals signals;
    if (!sample(range, {Signal::Noisy}, signals, stop)) return false;
    out = std::move(signals.noisySum());
    return true;
}

bool BlockTracer::traceLeaf(uint64_t first, SampleBlock& out, std::stop_token stop) {
    out = {};
    out.first = first;
    out.count = kLeafSamples;
    return traceSum({first, first + kLeafSamples}, out.sum, stop);
}

bool BlockTracer::traceBlock(SampleRange range, SampleBlock& out, std::stop_token stop) {
    SampleBlocks blocks;
    for (uint64_t first = range.begin; first < range.end; first += kLeafSamples) {
        SampleBlock leaf;
        if (!traceLeaf(first, leaf, stop)) return false;
        blocks.add(std::move(leaf));
    }
    out = blocks.release();
    return true;
}

Image BlockTracer::traceDepth() {
    Signals signals;
    sample({0, 1}, {Signal::Depth}, signals, {});
    return std::move(signals[Signal::Depth]);
}

}  // namespace lumi
