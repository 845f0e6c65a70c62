#include "scene/obj/obj_textures.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/files.h"
#include "base/parallel.h"
#include "image/decode.h"

namespace lumi {
namespace {

constexpr uint64_t kMaxImageBytes = uint64_t(1) << 30;

std::shared_ptr<TextureImage> finished(const std::string& name, bool srgb, Extent2 extent, std::vector<uint8_t> rgba) {
    auto image = std::make_shared<TextureImage>();
    image->name = name;
    image->srgb = srgb;
    image->levels.push_back({extent, std::move(rgba), {}});
    buildMips(*image);
    return image;
}

/// Nearest texel of `image` for texel (x, y) of an image of another size.
const uint8_t* texelAt(const Image8& image, Extent2 of, int x, int y) {
    const int64_t sx = int64_t(x) * image.extent.width / of.width, sy = int64_t(y) * image.extent.height / of.height;
    return &image.rgba[static_cast<size_t>(4 * (sy * image.extent.width + sx))];
}

bool isGrey(const Image8& image) {
    for (size_t i = 0; i < image.rgba.size(); i += 4)
        if (image.rgba[i] != image.rgba[i + 1] || image.rgba[i] != image.rgba[i + 2]) return false;
    return true;
}

bool hasAlpha(const Image8& image) {
    for (size_t i = 3; i < image.rgba.size(); i += 4)
        if (image.rgba[i] != 255) return true;
    return false;
}

/// Larger of two extents, by area; either may be absent.
Extent2 largerOf(const Image8* a, const Image8* b) {
    if (!a) return b->extent;
    return b && b->extent.area() > a->extent.area() ? b->extent : a->extent;
}

}  // namespace

void ObjImages::request(const std::string& name) {
    if (!name.empty()) files_.try_emplace(name);
}

void ObjImages::loadFile(const std::string& name, File& file) const {
    std::string portable = name;
    std::replace(portable.begin(), portable.end(), '\\', '/');
    try {
        const std::optional<std::filesystem::path> path = pathInside(folder_, portable);
        if (!path) throwBadInput({.what = "leads out of the .obj's folder", .where = name});
        const std::vector<uint8_t> bytes = readFile(*path, kMaxImageBytes);
        file.digest = digest64(bytes);
        file.image = decodeImage8(bytes, name);
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::BadInput) throw;
        warnings_.warnWhole(std::string(error.what()) + "; the material is shown without it");
    }
}

void ObjImages::load(std::stop_token stop) {
    std::vector<std::pair<const std::string, File>*> queue;
    for (auto& entry : files_) queue.push_back(&entry);
    parallelFor(
        static_cast<int64_t>(queue.size()),
        [&](int64_t i) { loadFile(queue[static_cast<size_t>(i)]->first, queue[static_cast<size_t>(i)]->second); },
        stop);
}

uint64_t ObjImages::digest() const {
    uint64_t digest = 0;
    for (const auto& [name, file] : files_)
        digest = digest64({reinterpret_cast<const uint8_t*>(&file.digest), sizeof(file.digest)}, digest);
    return digest;
}

const Image8* ObjImages::find(const std::string& name) const {
    const auto found = files_.find(name);
    return found == files_.end() || found->second.image.extent.empty() ? nullptr : &found->second.image;
}

std::shared_ptr<TextureImage> ObjImages::plain(const std::string& name, bool srgb) const {
    const Image8* image = find(name);
    if (!image) return nullptr;
    std::vector<uint8_t> rgba = image->rgba;
    for (size_t i = 3; i < rgba.size(); i += 4) rgba[i] = 255;
    return finished(name, srgb, image->extent, std::move(rgba));
}

std::shared_ptr<TextureImage> ObjImages::withAlpha(const std::string& colour, const std::string& opacity) const {
    const Image8 *base = find(colour), *cover = find(opacity);
    if (!cover) return plain(colour, true);
    const Extent2 extent = largerOf(base, cover);
    const size_t channel = hasAlpha(*cover) ? 3 : 0;
    std::vector<uint8_t> rgba(4 * static_cast<size_t>(extent.area()), 255);
    for (int y = 0; y < extent.height; ++y)
        for (int x = 0; x < extent.width; ++x) {
            uint8_t* out = &rgba[static_cast<size_t>(4 * (int64_t(y) * extent.width + x))];
            if (base) std::copy_n(texelAt(*base, extent, x, y), 3, out);
            out[3] = texelAt(*cover, extent, x, y)[channel];
        }
    return finished(colour.empty() ? opacity : colour, true, extent, std::move(rgba));
}

std::shared_ptr<TextureImage> ObjImages::metallicRoughness(const std::string& metallic,
                                                           const std::string& roughness) const {
    const Image8 *metal = find(metallic), *rough = find(roughness);
    if (!metal && !rough) return nullptr;
    const Extent2 extent = largerOf(metal, rough);
    std::vector<uint8_t> rgba(4 * static_cast<size_t>(extent.area()), 255);
    for (int y = 0; y < extent.height; ++y)
        for (int x = 0; x < extent.width; ++x) {
            uint8_t* out = &rgba[static_cast<size_t>(4 * (int64_t(y) * extent.width + x))];
            if (rough) out[1] = texelAt(*rough, extent, x, y)[0];
            if (metal) out[2] = texelAt(*metal, extent, x, y)[0];
        }
    return finished(rough ? roughness : metallic, false, extent, std::move(rgba));
}

std::shared_ptr<TextureImage> ObjImages::normalsFromBump(const std::string& name, float multiplier) const {
    const Image8* image = find(name);
    if (!image) return nullptr;
    if (!isGrey(*image)) return plain(name, false);
    const int width = image->extent.width, height = image->extent.height;  // clang 14 captures no structured bindings
    const auto heightAt = [&](int x, int y) {
        const int wx = (x + width) % width, wy = (y + height) % height;
        return multiplier * static_cast<float>(image->rgba[static_cast<size_t>(4 * (int64_t(wy) * width + wx))]) / 255;
    };
    std::vector<uint8_t> rgba(image->rgba.size(), 255);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            // Heights are in texels; +Y of a normal map is up, rows go down.
            const Vec3 normal = glm::normalize(Vec3(0.5f * (heightAt(x - 1, y) - heightAt(x + 1, y)),
                                                    0.5f * (heightAt(x, y + 1) - heightAt(x, y - 1)), 1));
            uint8_t* out = &rgba[static_cast<size_t>(4 * (int64_t(y) * width + x))];
            for (int c = 0; c < 3; ++c) out[c] = static_cast<uint8_t>(std::lround(127.5f + 127.5f * normal[c]));
        }
    return finished(name + " (normals)", false, image->extent, std::move(rgba));
}

}  // namespace lumi
