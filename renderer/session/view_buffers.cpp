#include "session/view_buffers.h"

#include <cstring>

#include "reconstruct/catalog.h"

namespace lumi {
namespace {

int drawnViews(const Document& document) { return document.layout() == Layout::Single ? 1 : kViewCount; }

}  // namespace

SignalSet shownSignals(const Document& document) {
    SignalSet signals;
    for (int i = 0; i < drawnViews(document); ++i)
        if (const Signal signal = signalByName(document.view(i).buffer); signal != Signal::Count) signals.add(signal);
    return signals;
}

std::map<std::string, TapSet> shownTaps(const Document& document) {
    std::map<std::string, TapSet> taps;
    for (int i = 0; i < drawnViews(document); ++i) {
        const ViewSettings& view = document.view(i);
        if (view.buffer != "image" && signalByName(view.buffer) == Signal::Count) taps[view.module].insert(view.buffer);
    }
    return taps;
}

const char* defaultColourMap(Signal signal) {
    switch (signal) {
        case Signal::Motion: return "motion";
        case Signal::DepthGradient: return "wheel";
        case Signal::Visibility:
        case Signal::Roughness: return "gray";
        case Signal::SampleVariance: return "magma";
        case Signal::ObjectId:
        case Signal::MaterialId:
        case Signal::Surface: return "ids";
        default: break;
    }
    return std::strlen(signalInfo(signal).channels) == 3 ? "none" : "viridis";
}

BufferView findBuffer(const FrameOutput& frame, const std::string& instance, const std::string& buffer) {
    if (const Signal signal = signalByName(buffer); signal != Signal::Count) {
        if (!frame.signals || !frame.signals->available().has(signal)) return {};
        const SignalInfo& info = signalInfo(signal);
        BufferView view{nullptr, nullptr, info.channels, defaultColourMap(signal), {}};
        if (info.isId) view.ids = &frame.signals->ids(signal);
        else view.image = &(*frame.signals)[signal];
        return view;
    }
    if (buffer == "image") {
        const auto result = frame.results.find(instance);
        return {result == frame.results.end() ? nullptr : result->second.get(), nullptr, "RGB", "none", {}};
    }
    const auto tap = frame.taps.find(instance + "-" + buffer);
    if (tap == frame.taps.end()) return {};
    const auto module = findModule(instance).make();
    for (const Tap& declared : module->taps())
        if (declared.name == buffer)
            return {tap->second.get(), nullptr, declared.channels, declared.colourMap, declared.range};
    return {};
}

std::shared_ptr<const Image8> drawView(const FrameOutput& frame, const ViewSettings& view, DisplayInfo& info) {
    auto pixels = std::make_shared<Image8>();
    BufferView buffer = findBuffer(frame, view.module, view.buffer);
    if (!buffer.image && !buffer.ids) buffer = findBuffer(frame, view.module, "image");
    if (buffer.ids) info = convert(*buffer.ids, view.display, *pixels);
    else if (buffer.image)
        info = convert(*buffer.image, buffer.channels.c_str(), buffer.colourMap.c_str(), view.display, *pixels,
                       buffer.range);
    return pixels;
}

}  // namespace lumi
