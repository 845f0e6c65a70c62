#include <cmath>
#include "base/error.h"
#include "base/files.h"
#include "image/decode.h"
#include "image/exr.h"
#include "image/hdr.h"
#include "image/png.h"
#include "math/colour.h"

namespace lumi {
namespace {

Image linearFromBytes(const Image8& image) {
    Image linear(image.extent, 3);
    const float* table = linearFromSrgbTable();
    const auto area = static_cast<size_t>(image.extent.area());
    for (int c = 0; c < 3; ++c) {
        float* plane = linear.plane(c).data;
        for (size_t i = 0; i < area; ++i) plane[i] = table[image.rgba[i * 4 + static_cast<size_t>(c)]];
    }
    return linear;
}

Image linearFromPng(const Png& png) {
    if (png.bitDepth == 8) return linearFromBytes(png.image8());
    Image linear(png.extent, 3);
    const auto area = static_cast<size_t>(png.extent.area());
    for (int c = 0; c < 3; ++c) {
        float* plane = linear.plane(c).data;
        for (size_t i = 0; i < area; ++i)
            plane[i] = linearFromSrgb(static_cast<float>(png.rgba[i * 4 + static_cast<size_t>(c)]) / 65535.0f);
    }
    return linear;
}

/// The picture of a file: its root colours, else its luminance, else its only layer of colours.
Image pictureOf(const ExrLayers& layers, const std::string& name) {
    if (Image root = layers.image("", "RGB"); !root.empty()) return root;
    for (const auto& [channel, values] : layers.channels) {
        if (!channel.ends_with(".R")) continue;
        if (Image layer = layers.image(channel.substr(0, channel.size() - 2), "RGB"); !layer.empty()) return layer;
    }
    if (const Image grey = layers.image("", "Y"); !grey.empty()) {
        Image picture(grey.extent(), 3);
        for (int c = 0; c < 3; ++c) std::copy(grey.data(), grey.data() + grey.size(), picture.plane(c).data);
        return picture;
    }
    std::string found;
    for (const auto& [channel, values] : layers.channels) found += (found.empty() ? "" : ", ") + channel;
    throwBadInput({"holds no picture", name, "channels R, G, B or Y", found});
}

}  // namespace

Image loadImage(const std::filesystem::path& path) {
    const std::string extension = lowerExtension(path);
    if (extension == ".exr") return pictureOf(readExr(path), path.string());
    if (extension == ".hdr" || extension == ".pic" || extension == ".rgbe")
        return decodeHdr(readFile(path), path.string());
    if (extension == ".png") return linearFromPng(readPng(path));
    if (extension == ".jpg" || extension == ".jpeg" || extension == ".bmp" || extension == ".tga")
        return linearFromBytes(decodeImage8(readFile(path), path.string()));
    throwBadInput({"unknown image format", path.string(), ".exr, .hdr, .png, .jpg, .bmp or .tga", extension});
}

bool isLinearFile(const std::filesystem::path& path) {
    const std::string extension = lowerExtension(path);
    return extension == ".exr" || extension == ".hdr" || extension == ".pic" || extension == ".rgbe";
}

void takeBackExposure(Image& picture, float exposureEv) {
    const float factor = std::exp2(-exposureEv);
    for (size_t i = 0; i < picture.size(); ++i) picture.data()[i] *= factor;
}

}  // namespace lumi
