#include "session/export.h"

#include <fmt/format.h>

#include <glm/gtc/matrix_transform.hpp>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/files.h"
#include "image/png.h"
#include "reconstruct/catalog.h"
#include "session/view_buffers.h"

namespace lumi {
using nlohmann::json;
namespace {

std::string moduleOf(const std::string& instance) { return instance.substr(0, instance.find('@')); }

}  // namespace

BufferSelection BufferSelection::all(const std::string& instance) {
    BufferSelection selection{SignalSet::all(), {}};
    const auto module = findModule(instance).make();
    for (const Tap& tap : module->taps()) selection.taps.insert(tap.name);
    return selection;
}

BufferSelection BufferSelection::parse(const std::string& text, const std::string& instance, const std::string& where) {
    const BufferSelection every = all(instance);
    const std::string head = moduleOf(instance) + "-";
    BufferSelection selection;
    size_t begin = 0;
    while (begin < text.size()) {
        const size_t comma = std::min(text.find(',', begin), text.size());
        std::string name = text.substr(begin, comma - begin);
        begin = comma + 1;
        if (name == "all") return every;
        if (name.empty() || name == "image") continue;
        if (const Signal signal = signalByName(name); signal != Signal::Count) {
            selection.signals.add(signal);
            continue;
        }
        const std::string tap = name.compare(0, head.size(), head) == 0 ? name.substr(head.size()) : name;
        if (every.taps.count(tap)) {
            selection.taps.insert(tap);
            continue;
        }
        std::vector<std::string> names{"all"};
        for (int i = 0; i < kSignalCount; ++i) names.emplace_back(signalInfo(static_cast<Signal>(i)).name);
        for (const std::string& known : every.taps) names.push_back(head + known);
        const std::string near = nearestName(name, names);
        throwUsage({fmt::format("unknown buffer \"{}\"", name), where,
                    near.empty() ? "names from `lumiscope list buffers`" : '"' + near + '"', ""});
    }
    return selection;
}

json OutputChoice::json() const { return {{"view", view}, {"buffers", buffers}, {"half", half}}; }

OutputChoice OutputChoice::parse(const nlohmann::json& value, const std::string& where) {
    try {
        OutputChoice choice{value.value("view", 0), value.value("buffers", ""), value.value("half", false)};
        if (choice.view >= 0 && choice.view < kViewCount) return choice;
    } catch (const nlohmann::json::exception&) {
    }
    throwBadInput({"the embedded state's \"output\" is damaged", where, "", value.dump()});
}

Mat4 ndcFromCamera(const CameraPose& camera) {
    const float aspect = static_cast<float>(camera.extent.width) / static_cast<float>(camera.extent.height);
    const float height = camera.halfHeight, width = height * aspect;
    constexpr float nearest = 0.01f, farthest = 10000;
    if (camera.projection == Projection::Orthographic)
        return glm::ortho(-width, width, -height, height, nearest, farthest);
    return glm::frustum(-width * nearest, width * nearest, -height * nearest, height * nearest, nearest, farthest);
}

ExrLayers exportLayers(const FrameOutput& frame, const std::string& instance, const BufferSelection& buffers,
                       const std::string& state) {
    ExrLayers layers;
    const Image& result = *frame.results.at(instance);
    layers.add("", "RGB", result);
    Image alpha(result.extent(), 1);
    alpha.fill(1);
    layers.add("", "A", alpha);
    if (frame.signals->available().has(Signal::Depth)) layers.add("", "Z", (*frame.signals)[Signal::Depth]);
    for (int i = 0; i < kSignalCount; ++i) {
        const Signal signal = static_cast<Signal>(i);
        if (!buffers.signals.has(signal) || !frame.signals->available().has(signal)) continue;
        const SignalInfo& info = signalInfo(signal);
        if (info.isId) layers.addIds(info.name, info.channels, frame.signals->ids(signal));
        else layers.add(info.name, info.channels, (*frame.signals)[signal]);
    }
    for (const std::string& tap : buffers.taps) {
        const BufferView view = findBuffer(frame, instance, tap);
        if (view.image) layers.add(moduleOf(instance) + "-" + tap, view.channels, *view.image);
    }
    layers.strings[kStateKey] = state;
    layers.worldToCamera = frame.camera.cameraFromWorld;
    layers.worldToNdc = ndcFromCamera(frame.camera) * frame.camera.cameraFromWorld;
    return layers;
}

std::vector<uint8_t> encodeView(const std::filesystem::path& name, const FrameOutput& frame, const ViewSettings& view,
                                const BufferSelection& buffers, bool half, const std::string& state, size_t* clamped) {
    const std::string extension = lowerExtension(name);
    if (clamped) *clamped = 0;
    if (extension == ".exr") return encodeExr(exportLayers(frame, view.module, buffers, state), half, clamped);
    if (extension != ".png")
        throwUsage({"cannot write this kind of file", name.string(), ".exr or .png", '"' + extension + '"'});
    DisplayInfo info;
    return encodePng(*drawView(frame, view, info), {{kStateKey, state}});
}

void Written::warn(MessageLog& log) const {
    if (clamped == 0) return;
    log.warning(fmt::format("{}: {} {} beyond what half holds and became {}; a float EXR holds {}", path.string(),
                            clamped, clamped == 1 ? "value was" : "values were", kMostHalf,
                            clamped == 1 ? "it" : "them"));
}

Written writeView(const std::filesystem::path& path, const FrameOutput& frame, const ViewSettings& view,
                  const BufferSelection& buffers, bool half, const std::string& state) {
    Written written{path};
    writeFileAtomically(path, encodeView(path, frame, view, buffers, half, state, &written.clamped));
    return written;
}

Written exportView(const std::filesystem::path& path, const FrameOutput& frame, const Document& document,
                   const OutputChoice& choice, const std::string& state) {
    const ViewSettings& view = document.view(choice.view);
    const BufferSelection buffers = BufferSelection::parse(choice.buffers, view.module, "--buffers");
    return writeView(path, frame, view, buffers, choice.half, state);
}

Written exportNewView(const std::filesystem::path& path, const FrameOutput& frame, const Document& document,
                      const OutputChoice& choice, const std::string& state) {
    const ViewSettings& view = document.view(choice.view);
    const BufferSelection buffers = BufferSelection::parse(choice.buffers, view.module, "--buffers");
    Written written;
    written.path = writeNewFile(path, encodeView(path, frame, view, buffers, choice.half, state, &written.clamped));
    return written;
}

}  // namespace lumi
