#pragma once
#include <map>
#include <memory>
#include <mutex>
#include <utility>

#include "scene/gltf/document.h"
#include "scene/texture.h"

namespace lumi::gltf {

/// What the texels of an image mean: decides the encoding, and what stands in for an image that cannot be read.
enum class TextureUse { Colour, Data, Normal };

/// The images of a file: materials ask for textures first, then all images that someone uses are read and decoded in
/// parallel. One image used both as colour and as data is decoded once and kept twice.
class TextureLibrary {
public:
    explicit TextureLibrary(const Document& document) : document_(document) {}

    /// The texture behind a glTF textureInfo; an `index` below 0 gives none. Its image is empty until load(); its uvSet
    /// is the file's number.
    Texture texture(int index, int texCoord, const tinygltf::ExtensionMap& extensions, TextureUse use,
                    const std::string& jsonPath);

    /// Makes glTF's metallic-roughness (G = 1 - gloss) of a specular-glossiness texture (A = gloss) once it is decoded.
    Texture roughnessFromGloss(const Texture& specularGloss, float glossFactor);

    /// Reads, decodes and builds the mip levels of every image asked for. What cannot be read gets a stand-in and
    /// a warning. `step` is called after each image with the share that is done. Polls the document's stop token.
    void load(const std::function<void(float)>& step);

    /// Digest of all encoded images, in the order of the file.
    uint64_t digest() const;

private:
    struct Entry {
        std::shared_ptr<TextureImage> images[3];  ///< by TextureUse
        uint64_t digest = 0;
    };
    /// What a roughness image is made of: the image with the gloss, and the material's factor.
    using Gloss = std::pair<std::shared_ptr<const TextureImage>, float>;
    void loadImage(int index, Entry& entry) const;
    void fillGlosses();
    void fill(Entry& entry, TextureImage::Level level) const;
    std::shared_ptr<TextureImage> standIn(TextureUse use) const;
    static void showStandIn(Entry& entry);
    void countUnsupported(const std::string& format) const;
    void warnUnsupported() const;

    const Document& document_;
    std::map<int, Entry> entries_;  ///< by glTF image
    std::map<Gloss, std::shared_ptr<TextureImage>> glosses_;
    mutable std::mutex mutex_;
    mutable std::map<std::string, int> unsupported_;  ///< textures and images of each format that is not read
};

}  // namespace lumi::gltf
