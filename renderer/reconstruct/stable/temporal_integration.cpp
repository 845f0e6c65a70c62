#include "reconstruct/stable/temporal_integration.h"

#include "base/parallel.h"

namespace lumi {
namespace {

constexpr int64_t kPixels = 4096;

}  // namespace

void TemporalIntegration::describe(ParameterVisitor& v) {
    v.toggle("temporal", enabled_,
             {.label = "Temporal integration",
              .help = "Blend the image with the frames before it, clipped to its neighbourhood's colours (sec. 6)"});
    v.when(enabled_, [&] { settings_.describe(v); });
}

bool TemporalIntegration::run(const FrameContext& context, const Image& motion, Image& image) {
    auto step = history_.begin(context.frame, context.changes.cut);
    if (!enabled_) {
        step.next = {};  // a later frame starts its history anew
        return true;
    }
    const auto measured = context.timer.measure("temporal");
    if (length_.extent() != image.extent()) length_.reset(image.extent(), 1);
    parallelRanges(image.extent().area(), kPixels, [&](int64_t begin, int64_t end) {
        for (int64_t i = begin; i < end; ++i) {
            const float x = motion.plane(0).data[i], y = motion.plane(1).data[i];
            length_.data()[i] = x * x + y * y;
        }
    });
    return antialiasTemporally(TaaMotion{motion, length_}, settings_, exposureFactor(context.scene), image,
                               step.previous, scratch_, step.next, image, context.stop);
}

size_t TemporalIntegration::bytes() const {
    return scratch_.bytes() + length_.bytes() + history_.byteCount([](const Image& image) { return image.bytes(); });
}

void longestMotions(std::span<const uint32_t> first, std::span<const Vec2> motions, std::span<const uint8_t> hidden,
                    Image& out) {
    parallelRanges(out.extent().area(), kPixels, [&](int64_t begin, int64_t end) {
        for (auto pixel = static_cast<size_t>(begin); pixel < static_cast<size_t>(end); ++pixel) {
            Vec2 longest(0);
            for (uint32_t i = first[pixel]; i < first[pixel + 1]; ++i)
                if ((hidden.empty() || !hidden[i]) && glm::dot(motions[i], motions[i]) > glm::dot(longest, longest))
                    longest = motions[i];
            for (int c = 0; c < 2; ++c) out.plane(c).data[pixel] = longest[c];
        }
    });
}

}  // namespace lumi
