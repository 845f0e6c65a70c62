#include "reconstruct/catalog.h"
#include "session/session_impl.h"
#include "session/view_buffers.h"

namespace lumi {
namespace {

const char* groupOf(Signal signal) {
    switch (signal) {
        case Signal::Noisy:
        case Signal::Emission:
        case Signal::DirectDiffuse:
        case Signal::IndirectDiffuse:
        case Signal::DirectSpecular:
        case Signal::IndirectSpecular:
        case Signal::Direct:
        case Signal::Indirect:
        case Signal::Visibility:
        case Signal::SampleVariance: return "Lighting";
        case Signal::Albedo:
        case Signal::SpecularAlbedo:
        case Signal::Roughness:
        case Signal::MaterialId: return "Material";
        default: return "Geometry";
    }
}

void addValue(const std::string& name, const std::string& channels, const Image& image, Pixel pixel,
              std::vector<PixelValue>& values) {
    PixelValue& value = values.emplace_back();
    value.buffer = name;
    value.channels = channels;
    for (int c = 0; c < image.channels(); ++c) value.values.push_back(image.at(c, pixel.x, pixel.y));
}

}  // namespace

std::vector<BufferEntry> Session::buffers(const std::string& instance) const {
    const ModuleEntry& entry = findModule(instance);
    std::vector<BufferEntry> buffers{
        {"image", "Result", "RGB", "W/(m^2 sr)", std::string(entry.title) + ", the result"}};
    const auto module = entry.make();
    for (const Tap& tap : module->taps()) buffers.push_back({tap.name, entry.title, tap.channels, tap.unit, tap.help});
    for (const char* group : {"Lighting", "Material", "Geometry"})
        for (int i = 0; i < kSignalCount; ++i) {
            const Signal signal = static_cast<Signal>(i);
            const SignalInfo& info = signalInfo(signal);
            if (std::string(groupOf(signal)) == group)
                buffers.push_back({info.name, group, info.channels, info.unit, info.help});
        }
    return buffers;
}

std::vector<PixelValue> Session::inspect(const Snapshot& snapshot, Pixel pixel) const {
    std::vector<PixelValue> values;
    if (pixel.x < 0 || pixel.y < 0 || pixel.x >= snapshot.extent.width || pixel.y >= snapshot.extent.height)
        return values;
    for (const auto& [name, image] : snapshot.results) addValue(name, "RGB", *image, pixel, values);
    for (const auto& [name, image] : snapshot.taps) {
        const std::string instance = name.substr(0, name.rfind('-')), tap = name.substr(name.rfind('-') + 1);
        std::string channels;
        const auto module = findModule(instance).make();
        for (const Tap& declared : module->taps())
            if (declared.name == tap) channels = declared.channels;
        addValue(name, channels, *image, pixel, values);
    }
    for (int i = 0; i < kSignalCount && snapshot.signals; ++i) {
        const Signal signal = static_cast<Signal>(i);
        if (!snapshot.signals->available().has(signal)) continue;
        const SignalInfo& info = signalInfo(signal);
        if (!info.isId) {
            addValue(info.name, info.channels, (*snapshot.signals)[signal], pixel, values);
            continue;
        }
        PixelValue& value = values.emplace_back();
        value.buffer = info.name;
        value.channels = info.channels;
        value.isId = true;
        const IdImage& ids = snapshot.signals->ids(signal);
        for (int c = 0; c < ids.channels(); ++c) value.ids.push_back(ids.at(c, pixel.x, pixel.y));
    }
    return values;
}

void Session::saveView(int view, const std::filesystem::path& path, const std::string& buffers, bool half) {
    if (!snapshot()) return impl_->log.error(path.string() + ": there is no picture yet");
    std::lock_guard lock(impl_->mutex);
    impl_->saves.push_back({path, {view, buffers, half}});
    impl_->wake.notify_all();
}

void Session::captureView(int view, const std::filesystem::path& stem, const std::string& extension) {
    if (!snapshot()) return impl_->log.error(stem.string() + ": there is no picture yet");
    std::lock_guard lock(impl_->mutex);
    impl_->saves.push_back({stem, {view, "all", false}, extension});
    impl_->wake.notify_all();
}

std::future<std::optional<Vec3>> Session::surfaceAt(Pixel pixel) {
    const auto question = std::make_shared<Impl::Question>();
    question->pixel = pixel;
    std::future<std::optional<Vec3>> answer = question->answer.get_future();
    std::lock_guard lock(impl_->mutex);
    if (!impl_->snapshot) question->answer.set_value(std::nullopt);
    else impl_->questions.push_back(question);
    impl_->wake.notify_all();
    return answer;
}

int SignalCheck::brokenRules() const {
    int broken = 0;
    for (const FrameCheck& frame : frames)
        for (const ContractFinding& finding : frame.findings) broken += !finding.holds();
    return broken;
}

void Session::setCheckingScenes(bool on) {
    std::lock_guard lock(impl_->mutex);
    impl_->checkingScenes = on;
}

void Session::checkSignals() {
    std::lock_guard lock(impl_->mutex);
    impl_->checkWanted = impl_->document.has_value();
    impl_->wake.notify_all();
}

bool Session::checkingSignals() const {
    std::lock_guard lock(impl_->mutex);
    return impl_->checkWanted || impl_->checking;
}

std::shared_ptr<const SignalCheck> Session::signalCheck() const {
    std::lock_guard lock(impl_->mutex);
    return impl_->signalCheck;
}

std::string Session::stateJson() const {
    StateLog states;
    {
        std::lock_guard lock(impl_->mutex);
        states = impl_->states;
    }
    return states.empty() ? "{}" : states.json(OutputChoice{0, "all", false}.json());
}

}  // namespace lumi
