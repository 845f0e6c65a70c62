#include <algorithm>
#include <cassert>

#include "image/exr.h"

namespace lumi {
namespace {

std::string channelName(std::string_view layer, std::string_view letters, size_t index, bool plainIfSingle) {
    if (plainIfSingle && letters.size() == 1 && !layer.empty()) return std::string(layer);
    const std::string letter(1, letters[index]);
    return layer.empty() ? letter : std::string(layer) + '.' + letter;
}

void takeExtent(ExrLayers& layers, Extent2 extent) {
    if (layers.channels.empty()) layers.extent = extent;
    assert(layers.extent == extent);
}

}  // namespace

void ExrLayers::add(std::string_view layer, std::string_view letters, const Image& image, ExrType type) {
    assert(static_cast<int>(letters.size()) <= image.channels() && type != ExrType::Uint);
    takeExtent(*this, image.extent());
    const auto area = static_cast<size_t>(extent.area());
    for (size_t c = 0; c < letters.size(); ++c) {
        ExrChannel& channel = channels[channelName(layer, letters, c, false)];
        channel.type = type;
        channel.floats.assign(image.data() + c * area, image.data() + (c + 1) * area);
    }
}

void ExrLayers::addIds(std::string_view layer, std::string_view letters, const IdImage& image) {
    assert(static_cast<int>(letters.size()) <= image.channels());
    takeExtent(*this, image.extent());
    const auto area = static_cast<size_t>(extent.area());
    for (size_t c = 0; c < letters.size(); ++c) {
        ExrChannel& channel = channels[channelName(layer, letters, c, true)];
        channel.type = ExrType::Uint;
        channel.ids.assign(image.data() + c * area, image.data() + (c + 1) * area);
    }
}

Image ExrLayers::image(std::string_view layer, std::string_view letters) const {
    std::vector<const ExrChannel*> found;
    for (size_t c = 0; c < letters.size(); ++c) {
        const ExrChannel* channel = find(channelName(layer, letters, c, false));
        if (!channel) channel = find(channelName(layer, letters, c, true));
        if (!channel) return {};
        found.push_back(channel);
    }
    Image result(extent, static_cast<int>(letters.size()));
    for (size_t c = 0; c < found.size(); ++c) {
        float* target = result.plane(static_cast<int>(c)).data;
        if (found[c]->type == ExrType::Uint)
            std::transform(found[c]->ids.begin(), found[c]->ids.end(), target,
                           [](uint32_t id) { return static_cast<float>(id); });
        else std::copy(found[c]->floats.begin(), found[c]->floats.end(), target);
    }
    return result;
}

}  // namespace lumi
