#pragma once
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>

#include "image/image.h"
#include "scene/file_warnings.h"
#include "scene/load.h"
#include "scene/texture.h"

namespace lumi {

/// The image files that the materials of an .obj name. All are decoded in parallel by load(); then textures are put
/// together from them, since .mtl keeps in separate files what our textures keep in one.
class ObjImages {
public:
    ObjImages(std::filesystem::path folder, FileWarnings& warnings) : folder_(std::move(folder)), warnings_(warnings) {}

    /// Names a file that will be needed; empty names are ignored.
    void request(const std::string& name);
    /// Reads and decodes all requested files. Files that are missing, damaged or outside the .obj's folder are
    /// warnings.
    void load(std::stop_token stop);
    /// Digest of all the files.
    uint64_t digest() const;

    /// The file as it is; null if it could not be read.
    std::shared_ptr<TextureImage> plain(const std::string& name, bool srgb) const;
    /// RGB of `colour` (white without) with alpha from `opacity`: its alpha channel if it has one, else its red.
    std::shared_ptr<TextureImage> withAlpha(const std::string& colour, const std::string& opacity) const;
    /// G = red of `roughness`, B = red of `metallic`; what is missing is white.
    std::shared_ptr<TextureImage> metallicRoughness(const std::string& metallic, const std::string& roughness) const;
    /// A normal map: the file itself if it is coloured, else the slopes of the heights it holds.
    std::shared_ptr<TextureImage> normalsFromBump(const std::string& name, float multiplier) const;

private:
    struct File {
        Image8 image;
        uint64_t digest = 0;
    };
    const Image8* find(const std::string& name) const;
    void loadFile(const std::string& name, File& file) const;

    std::filesystem::path folder_;
    FileWarnings& warnings_;
    std::map<std::string, File> files_;
};

}  // namespace lumi
