#pragma once
#include <atomic>
#include <chrono>
#include <thread>

#include "reconstruct/catalog.h"
#include "reconstruct/module.h"
#include "trace/tracer.h"

namespace lumi::test {

/// Shows the raw frame, and does what a test tells it to: stops in the middle, or waits and hears no stop.
class ProbeModule : public Module {
public:
    static inline std::atomic<bool> stops{false};   ///< run() gives up
    static inline std::atomic<bool> holds{false};   ///< run() waits until this is false
    static inline std::atomic<bool> isHeld{false};  ///< it waits
    static inline std::atomic<int> wrongScenes{0};  ///< runs whose tracer had another scene than the frame

    SignalSet reads() const override { return {Signal::Noisy}; }
    Jitter preferredJitter() const override { return Jitter::PerPixel; }
    void describe(ParameterVisitor& v) override {
        v.toggle("again", again_, {.label = "Again", .help = "Runs the module again"});
    }
    void resize(Extent2) override {}
    void forget() override {}
    RunResult run(const FrameContext& context, Image& out) override {
        if (&context.tracer.scene() != &context.scene) ++wrongScenes;
        while (holds) {
            isHeld = true;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        isHeld = false;
        if (stops) return RunResult::Stopped;
        out = context.signals[Signal::Noisy];
        return RunResult::Completed;
    }
    bool keepsHistory(const Changes&) const override { return false; }

private:
    bool again_ = false;
};

/// For the whole test program: "probe".
inline const CatalogAddition kProbeInCatalogue{
    {"probe", "Probe", "", []() -> std::unique_ptr<Module> { return std::make_unique<ProbeModule>(); }}};

}  // namespace lumi::test
