#pragma once
#include <array>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>

#include "frame/display.h"
#include "session/document.h"

namespace lumi {

/// Pictures of a reference as the views beside it show theirs, so that what differs is the image and not its display.
/// Converted on a thread of its own whenever something changes; its functions return at once.
class ReferencePictures {
public:
    struct Source {
        std::shared_ptr<const Image> image;  ///< linear RGB
        /// Of a picture file: the exposure that is in it, and its tone curve with it. Others are none.
        std::optional<float> bakedExposureEv;
        bool operator==(const Source&) const = default;
    };

    ReferencePictures();
    ~ReferencePictures();

    /// What is shown, and by which displays; the present pictures stay until the new ones are there.
    void show(const Source& source, const std::array<DisplaySettings, kViewCount>& displays);
    /// Null before the first, and once nothing is shown.
    std::shared_ptr<const Image8> picture(int view) const;
    /// Are the pictures those of what was asked for last?
    bool current() const;
    /// Grows when the pictures change.
    uint64_t serial() const;

private:
    struct Wanted {
        Source source;
        std::array<DisplaySettings, kViewCount> displays;
        bool operator==(const Wanted&) const = default;
    };
    void run(std::stop_token quit);

    mutable std::mutex mutex_;
    std::condition_variable_any wake_;
    Wanted wanted_, done_;
    std::array<std::shared_ptr<const Image8>, kViewCount> pictures_;
    uint64_t serial_ = 0;
    std::jthread thread_;
};

}  // namespace lumi
