#include "scene/gltf/textures.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <string_view>

#include "base/error.h"
#include "base/files.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "image/decode.h"
#include "scene/gltf/values.h"

namespace lumi::gltf {
namespace {

constexpr uint64_t kMaxImageBytes = uint64_t(1) << 30;

Wrap wrapMode(const Document& document, int mode, const std::string& path) {
    switch (mode) {
        case TINYGLTF_TEXTURE_WRAP_REPEAT: return Wrap::Repeat;
        case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE: return Wrap::ClampToEdge;
        case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT: return Wrap::MirroredRepeat;
        default: document.fail(path, "no such wrap mode", "10497, 33071 or 33648", std::to_string(mode));
    }
}

/// -1: the file does not say.
TextureFilter filterOf(const Document& document, int filter, const std::string& path) {
    if (filter == TINYGLTF_TEXTURE_FILTER_NEAREST) return TextureFilter::Nearest;
    if (filter != -1 && filter != TINYGLTF_TEXTURE_FILTER_LINEAR)
        document.fail(path, "no such filter", "9728 or 9729", std::to_string(filter));
    return TextureFilter::Linear;
}

/// What stands in for an image that cannot be read: a magenta and grey checker for colours, neutral values for data.
TextureImage::Level standInLevel(TextureUse use) {
    if (use == TextureUse::Data) return {{1, 1}, {255, 255, 255, 255}, {}};
    if (use == TextureUse::Normal) return {{1, 1}, {128, 128, 255, 255}, {}};
    return {{2, 2}, {255, 0, 255, 255, 90, 90, 90, 255, 90, 90, 90, 255, 255, 0, 255, 255}, {}};
}

/// What a texture without an image of its own is encoded in.
std::string formatOf(const tinygltf::ExtensionMap& extensions) {
    constexpr std::pair<const char*, const char*> kFormats[] = {{"KHR_texture_basisu", "KTX2 (KHR_texture_basisu)"},
                                                                {"EXT_texture_webp", "WebP (EXT_texture_webp)"},
                                                                {"EXT_texture_avif", "AVIF (EXT_texture_avif)"},
                                                                {"MSFT_texture_dds", "DDS (MSFT_texture_dds)"}};
    for (const auto& [extension, format] : kFormats)
        if (extensions.contains(extension)) return format;
    return "an unknown format";
}

/// The same of an image's first bytes; empty if it may be one that is read.
std::string formatOf(std::span<const uint8_t> bytes) {
    const auto has = [&](size_t offset, std::string_view magic) {
        return bytes.size() >= offset + magic.size() &&
               std::memcmp(bytes.data() + offset, magic.data(), magic.size()) == 0;
    };
    if (has(0, "\xABKTX 20\xBB")) return "KTX2 (KHR_texture_basisu)";
    if (has(0, "RIFF") && has(8, "WEBP")) return "WebP (EXT_texture_webp)";
    if (has(4, "ftypavif")) return "AVIF (EXT_texture_avif)";
    if (has(0, "DDS ")) return "DDS (MSFT_texture_dds)";
    return {};
}

}  // namespace

Texture TextureLibrary::texture(int index, int texCoord, const tinygltf::ExtensionMap& extensions, TextureUse use,
                                const std::string& jsonPath) {
    if (index < 0) return {};
    const tinygltf::Model& model = document_.model();
    document_.checkIndex(index, model.textures.size(), jsonPath + "/index", "textures");
    const tinygltf::Texture& source = model.textures[static_cast<size_t>(index)];
    const std::string texturePath = "/textures/" + std::to_string(index);

    Texture texture;
    if (source.sampler >= 0) {
        document_.checkIndex(source.sampler, model.samplers.size(), texturePath + "/sampler", "samplers");
        const tinygltf::Sampler& sampler = model.samplers[static_cast<size_t>(source.sampler)];
        const std::string path = "/samplers/" + std::to_string(source.sampler);
        texture.wrapU = wrapMode(document_, sampler.wrapS, path + "/wrapS");
        texture.wrapV = wrapMode(document_, sampler.wrapT, path + "/wrapT");
        texture.filter = filterOf(document_, sampler.magFilter, path + "/magFilter");
    }
    texture.uvSet = texCoord;
    if (const auto found = extensions.find("KHR_texture_transform"); found != extensions.end()) {
        const tinygltf::Value& transform = found->second;
        texture.offset = vec2Of(transform, "offset", Vec2(0));
        texture.scale = vec2Of(transform, "scale", Vec2(1));
        texture.rotation = numberOf(transform, "rotation", 0);
        texture.uvSet = static_cast<int>(numberOf(transform, "texCoord", static_cast<float>(texCoord)));
    }
    texture.uvSet = std::clamp(texture.uvSet, 0, 1 << 20);
    if (source.source < 0) {
        countUnsupported(formatOf(source.extensions));
        texture.image = standIn(use);
        return texture;
    }
    document_.checkIndex(source.source, document_.images().size(), texturePath + "/source", "images");
    std::shared_ptr<TextureImage>& image = entries_[source.source].images[static_cast<int>(use)];
    if (!image) {
        image = std::make_shared<TextureImage>();
        image->name = document_.images()[static_cast<size_t>(source.source)].name;
        image->srgb = use == TextureUse::Colour;
    }
    texture.image = image;
    return texture;
}

Texture TextureLibrary::roughnessFromGloss(const Texture& specularGloss, float glossFactor) {
    std::shared_ptr<TextureImage>& image = glosses_[{specularGloss.image, glossFactor}];
    if (!image) {
        image = std::make_shared<TextureImage>();
        image->name = specularGloss.image->name + " (roughness)";
    }
    Texture texture = specularGloss;
    texture.image = image;
    return texture;
}

std::shared_ptr<TextureImage> TextureLibrary::standIn(TextureUse use) const {
    auto image = std::make_shared<TextureImage>();
    image->name = "stand-in";
    image->srgb = use == TextureUse::Colour;
    image->levels.push_back(standInLevel(use));
    buildMips(*image);
    return image;
}

void TextureLibrary::fill(Entry& entry, TextureImage::Level level) const {
    int users = static_cast<int>(std::count_if(std::begin(entry.images), std::end(entry.images),
                                               [](const auto& image) { return image != nullptr; }));
    for (const auto& image : entry.images) {
        if (!image) continue;
        if (--users > 0) image->levels.push_back(level);
        else image->levels.push_back(std::move(level));
        buildMips(*image);
    }
}

void TextureLibrary::showStandIn(Entry& entry) {
    for (int use = 0; use < 3; ++use)
        if (entry.images[use]) {
            entry.images[use]->levels.assign(1, standInLevel(static_cast<TextureUse>(use)));
            buildMips(*entry.images[use]);
        }
}

void TextureLibrary::loadImage(int index, Entry& entry) const {
    const ImageSource& source = document_.images()[static_cast<size_t>(index)];
    const std::string jsonPath = "/images/" + std::to_string(index);
    std::vector<uint8_t> file;
    std::span<const uint8_t> bytes = source.bytes;
    if (source.bufferView >= 0) bytes = document_.bufferView(source.bufferView, jsonPath + "/bufferView");
    try {
        if (!source.file.empty()) {
            file = readFile(source.file, kMaxImageBytes);
            bytes = file;
        }
        if (!source.fault.empty()) throwBadInput({.what = source.fault});
        if (bytes.empty())
            throwBadInput({.what = source.name.starts_with("data:")
                                       ? "an unsupported kind of data URI, \"" + source.name + '"'
                                       : "the image \"" + source.name.substr(0, 200) + "\" does not exist"});
        entry.digest = digest64(bytes);
        if (const std::string format = formatOf(bytes); !format.empty()) {
            countUnsupported(format);
            return showStandIn(entry);
        }
        Image8 decoded = decodeImage8(bytes, source.name);
        fill(entry, {decoded.extent, std::move(decoded.rgba), {}});
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::BadInput) throw;
        document_.warn(jsonPath + ": " + error.what() + "; a stand-in is shown");
        showStandIn(entry);
    }
}

void TextureLibrary::countUnsupported(const std::string& format) const {
    const std::lock_guard lock(mutex_);
    ++unsupported_[format];
}

void TextureLibrary::warnUnsupported() const {
    for (const auto& [format, count] : unsupported_)
        document_.warn(std::to_string(count) + (count == 1 ? " texture is in " : " textures are in ") + format +
                       ", which is not supported; stand-ins are shown");
}

void TextureLibrary::load(const std::function<void(float)>& step) {
    std::vector<std::pair<const int, Entry>*> queue;
    for (auto& entry : entries_) queue.push_back(&entry);
    std::atomic<int> done = 0;
    parallelFor(static_cast<int64_t>(queue.size()), [&](int64_t i) {
        document_.pollStop();
        auto& [index, entry] = *queue[static_cast<size_t>(i)];
        loadImage(index, entry);
        step(static_cast<float>(++done) / static_cast<float>(queue.size()));
    });
    warnUnsupported();
    fillGlosses();
}

void TextureLibrary::fillGlosses() {
    std::vector<std::pair<const Gloss, std::shared_ptr<TextureImage>>*> queue;
    for (auto& gloss : glosses_) queue.push_back(&gloss);
    parallelFor(static_cast<int64_t>(queue.size()), [&](int64_t g) {
        document_.pollStop();
        const auto& [gloss, image] = *queue[static_cast<size_t>(g)];
        const auto& [from, factor] = gloss;
        checkMemory("the texture " + image->name, from->byteCount());
        TextureImage::Level level = from->levels.front();
        for (size_t i = 0; i < level.bytes.size(); i += 4) {
            const float roughness = 255 - factor * static_cast<float>(level.bytes[i + 3]);
            level.bytes[i + 1] = static_cast<uint8_t>(std::clamp(roughness + 0.5f, 0.0f, 255.0f));
            level.bytes[i + 2] = 255;
        }
        image->levels.push_back(std::move(level));
        buildMips(*image);
    });
}

uint64_t TextureLibrary::digest() const {
    uint64_t digest = 0;
    for (const auto& [index, entry] : entries_) {
        const uint64_t part[2] = {static_cast<uint64_t>(index), entry.digest};
        digest = digest64({reinterpret_cast<const uint8_t*>(part), sizeof(part)}, digest);
    }
    return digest;
}

}  // namespace lumi::gltf
