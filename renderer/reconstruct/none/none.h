#pragma once
#include "reconstruct/module.h"

namespace lumi {

/// The raw frame, or one part of its light: what every method starts from.
/// Values that are no numbers stay in their pixel.
class NoneModule : public Module {
public:
    enum class Component { All, Direct, Indirect, Emission };

    SignalSet reads() const override;
    void describe(ParameterVisitor&) override;
    void resize(Extent2 extent) override { extent_ = extent; }
    void forget() override {}
    RunResult run(const FrameContext&, Image& out) override;
    bool keepsHistory(const Changes&) const override { return false; }

private:
    Signal signal() const;

    Extent2 extent_;
    Component component_ = Component::All;
};

}  // namespace lumi
