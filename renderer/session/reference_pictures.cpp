#include "session/reference_pictures.h"

#include <new>

#include "base/parallel.h"

namespace lumi {
namespace {

using Pictures = std::array<std::shared_ptr<const Image8>, kViewCount>;

/// A picture file has its curve in it: only the difference of exposures is left to apply.
std::shared_ptr<const Image8> converted(const ReferencePictures::Source& source, DisplaySettings display) {
    if (source.bakedExposureEv) {
        display.exposureEv -= *source.bakedExposureEv;
        display.curve = ToneCurve::Clamp;
    }
    auto pixels = std::make_shared<Image8>();
    convert(*source.image, "RGB", "none", display, *pixels);
    return pixels;
}

/// Views that show it alike share one.
Pictures picturesOf(const ReferencePictures::Source& source, const std::array<DisplaySettings, kViewCount>& displays) {
    Pictures pictures;
    for (size_t i = 0; i < pictures.size(); ++i)
        pictures[i] = i > 0 && displays[i] == displays[0] ? pictures[0] : converted(source, displays[i]);
    return pictures;
}

}  // namespace

ReferencePictures::ReferencePictures() {
    thread_ = std::jthread([this](std::stop_token quit) { run(quit); });
}

ReferencePictures::~ReferencePictures() {
    thread_.request_stop();
    wake_.notify_all();
}

void ReferencePictures::show(const Source& source, const std::array<DisplaySettings, kViewCount>& displays) {
    std::lock_guard lock(mutex_);
    if (source.image != wanted_.source.image) pictures_ = {};
    wanted_ = {source, displays};
    if (wanted_ != done_) wake_.notify_all();
}

std::shared_ptr<const Image8> ReferencePictures::picture(int view) const {
    std::lock_guard lock(mutex_);
    return pictures_[static_cast<size_t>(view)];
}

bool ReferencePictures::current() const {
    std::lock_guard lock(mutex_);
    return wanted_ == done_;
}

uint64_t ReferencePictures::serial() const {
    std::lock_guard lock(mutex_);
    return serial_;
}

void ReferencePictures::run(std::stop_token quit) {
    flushDenormals();
    while (!quit.stop_requested()) {
        std::unique_lock lock(mutex_);
        wake_.wait(lock, quit, [this] { return wanted_ != done_; });
        if (quit.stop_requested()) return;
        const Wanted wanted = wanted_;
        lock.unlock();
        Pictures pictures;
        try {
            if (wanted.source.image) pictures = picturesOf(wanted.source, wanted.displays);
        } catch (const std::bad_alloc&) {  // without memory for it, there is none to show
        }
        lock.lock();
        done_ = wanted;
        if (wanted.source.image == wanted_.source.image) pictures_ = std::move(pictures);
        ++serial_;
    }
}

}  // namespace lumi
