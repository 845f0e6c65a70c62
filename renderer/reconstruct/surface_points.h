#pragma once
#include <bit>

#include "reconstruct/module.h"
#include "trace/tracer.h"

namespace lumi {

/// The surface point that the first sample of a pixel saw, from Signal::Surface.
inline SurfacePoint surfacePointAt(const FrameContext& context, int x, int y) {
    const IdImage& surface = context.signals.ids(Signal::Surface);
    return {surface.at(0, x, y),
            surface.at(1, x, y),
            {std::bit_cast<float>(surface.at(2, x, y)), std::bit_cast<float>(surface.at(3, x, y))},
            context.sampling.timeOf(x, y, context.sampling.firstSample)};
}

}  // namespace lumi
