#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "base/files.h"
#include "base/messages.h"
#include "reconstruct/catalog.h"
#include "scene/load.h"
#include "trace/tracer.h"

namespace lumi::test {

/// Runs modules on frames of the Cornell box, or on signals that a test makes up.
class ModuleHarness {
public:
    explicit ModuleHarness(Extent2 extent, int samplesPerPixel = 1) : extent_(extent), spp_(samplesPerPixel) {
        static MessageLog log;
        static const std::shared_ptr<const Scene> scene = loadScene(LUMISCOPE_SOURCE_DIR "/scenes/cornell.json", log);
        scene_ = scene;
        posed_ = poseScene(scene_, {});
        tracer_.bind(posed_);
    }

    /// Every signal of frame `number`; the camera stands `shift` metres to the right of the scene's own, and stood
    /// `previousShift` to the right of it a frame earlier.
    Signals trace(FrameNumber number, float shift, float previousShift, Jitter jitter = Jitter::PerPixel) {
        FrameSampling sampling = samplingOf(number, shift);
        sampling.previousCamera = camera(previousShift);
        sampling.jitter = jitter;
        sampling.wanted = SignalSet::all();
        Signals signals;
        EXPECT_TRUE(tracer_.sample(sampling, signals));
        return signals;
    }

    /// The same without motion.
    Signals trace(FrameNumber number, float shift = 0, Jitter jitter = Jitter::PerPixel) {
        return trace(number, shift, shift, jitter);
    }

    FrameSampling samplingOf(FrameNumber number, float shift) const {
        FrameSampling sampling;
        sampling.extent = extent_;
        sampling.camera = sampling.previousCamera = camera(shift);
        sampling.frame = static_cast<uint32_t>(number);
        sampling.samplesPerPixel = spp_;
        sampling.firstSample = static_cast<uint64_t>(number) * static_cast<uint64_t>(spp_);
        return sampling;
    }

    CameraPose camera(float shift = 0) const {
        Camera camera = cameraAt(*scene_, 0, 0);
        camera.eye.x += shift;
        camera.target.x += shift;
        return poseCamera(camera, extent_);
    }

    struct Step {
        FrameNumber frame = 0;
        Changes changes;
        float shift = 0;
        bool stopped = false;
        std::optional<float> previousShift{};  ///< that of the frame itself if it is not given
    };
    RunResult run(Module& module, const Step& step, const Signals& signals, Image& out) {
        TapSet wanted;
        for (const Tap& tap : module.taps()) wanted.insert(tap.name);
        StageTimer timer;
        std::stop_source stop;
        if (step.stopped) stop.request_stop();
        const CameraPose pose = camera(step.shift);
        const FrameSampling sampling = samplingOf(step.frame, step.shift);
        return module.run({step.frame, signals, *posed_, pose, camera(step.previousShift.value_or(step.shift)),
                           step.changes, wanted, tracer_, sampling, timer, stop.get_token(), inspected},
                          out);
    }
    /// The image of a completed run; frame 0 is a cut.
    Image image(Module& module, FrameNumber frame, const Signals& signals, Changes changes = {}) {
        Image out;
        changes.cut |= frame == 0;
        EXPECT_EQ(run(module, {frame, changes, 0, false}, signals, out), RunResult::Completed);
        return out;
    }

    /// From now on the lights have a part of their power, or all of it again. One harness knows one part.
    void dimLights(bool dimmed, float part = 1.0f / 3) {
        if (dimmed && !dimmed_) {
            auto scene = std::make_shared<Scene>(*scene_);
            for (Light& light : scene->lights) light.power *= part;
            dimmed_ = poseScene(scene, {});
        }
        if (!bright_) bright_ = posed_;
        posed_ = dimmed ? dimmed_ : bright_;
        tracer_.bind(posed_);
    }

    Extent2 extent() const { return extent_; }

    std::optional<Pixel> inspected;  ///< that later runs are asked about

private:
    Extent2 extent_;
    int spp_;
    std::shared_ptr<const Scene> scene_;
    std::shared_ptr<const PosedScene> posed_, bright_, dimmed_;
    Tracer tracer_;
};

/// For suites over the catalogue: its entries, and their names as gtest takes them.
inline std::vector<const ModuleEntry*> catalogueEntries() {
    std::vector<const ModuleEntry*> entries;
    for (const ModuleEntry& entry : moduleCatalog()) entries.push_back(&entry);
    return entries;
}
/// Does it place its own rays? What a test makes up as signals does not reach it then.
inline bool tracesItself(const Module& module) { return module.reads().empty(); }

inline std::string testName(const testing::TestParamInfo<const ModuleEntry*>& entry) {
    std::string name = entry.param->id;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
}

/// Bits of an image and of every tap of the module's last run.
inline std::string digestOf(const Image& image, const Module& module) {
    const auto bytes = [](const Image& i) { return std::span(reinterpret_cast<const uint8_t*>(i.data()), i.bytes()); };
    std::string text = digest(bytes(image));
    for (const Tap& tap : module.taps()) text += ' ' + digest(bytes(module.tap(tap.name)));
    return text;
}

/// Signals of one colour everywhere, with noisySum to match; what is not a colour is flat and faces the camera.
inline Signals constantSignals(Extent2 extent, int samplesPerPixel, float value) {
    Signals signals;
    signals.reset(extent, SignalSet::all(), samplesPerPixel);
    for (int i = 0; i < kSignalCount; ++i) {
        const Signal signal = static_cast<Signal>(i);
        if (signalInfo(signal).isId) signals.ids(signal).fill(1);
        else signals[signal].fill(0);
    }
    signals[Signal::Noisy].fill(value);
    signals[Signal::Albedo].fill(1);
    signals[Signal::SpecularAlbedo].fill(1);
    signals[Signal::DirectDiffuse].fill(value);
    signals[Signal::Direct].fill(value);
    signals[Signal::Depth].fill(4);
    signals[Signal::InverseDepth].fill(0.25f);
    for (Signal normal : {Signal::Normal, Signal::GeometricNormal, Signal::ObjectNormal})
        for (int64_t p = 0; p < extent.area(); ++p) signals[normal].plane(2).data[p] = 1;
    signals.noisySum().fill(static_cast<double>(value) * samplesPerPixel);
    return signals;
}

inline int64_t countNonFinite(const Image& image) {
    int64_t count = 0;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            for (int c = 0; c < image.channels(); ++c)
                if (!std::isfinite(image.at(c, x, y))) {
                    ++count;
                    break;
                }
    return count;
}

}  // namespace lumi::test
