// What `compare` reads: images with their masks, crops, layers and the exposure they were made at.
#include <fmt/format.h>

#include <algorithm>

#include "app/compare_parts.h"
#include "base/error.h"
#include "base/files.h"
#include "image/exr.h"
#include "image/hdr.h"
#include "measure/metrics.h"
#include "session/replay.h"

namespace lumi {
namespace fs = std::filesystem;
namespace {

Image cropped(const Image& image, const std::array<int, 4>& crop, const std::string& where) {
    const auto [x, y, width, height] = crop;
    const bool inside =
        x >= 0 && y >= 0 && width > 0 && height > 0 && x + width <= image.width() && y + height <= image.height();
    if (!inside)
        throwUsage({"the crop leaves the image", where, fmt::format("a part of {}x{}", image.width(), image.height()),
                    fmt::format("{},{},{},{}", x, y, width, height)});
    Image out({width, height}, image.channels());
    for (int c = 0; c < image.channels(); ++c)
        for (int row = 0; row < height; ++row)
            std::copy_n(image.plane(c).row(y + row) + x, width, out.plane(c).row(row));
    return out;
}

Image croppedAs(const CompareOptions& options, Image image) {
    return options.crop && !image.empty() ? cropped(image, *options.crop, "--crop") : std::move(image);
}

Image luminanceMask(const Image& rgb) {
    Image mask(rgb.extent(), 1);
    for (int y = 0; y < rgb.height(); ++y)
        for (int x = 0; x < rgb.width(); ++x)
            mask.at(0, x, y) = luminance(Vec3(rgb.at(0, x, y), rgb.at(1, x, y), rgb.at(2, x, y)));
    return mask;
}

struct LoadedFile {
    Image rgb, motion, depth;
    bool linear = false;  ///< not as shown
    std::optional<float> exposureEv;
};

LoadedFile load(const fs::path& path, bool layers) {
    LoadedFile file;
    file.linear = isLinearFile(path);
    if (lowerExtension(path) == ".exr") {
        const ExrLayers content = readExr(path);
        file.rgb = content.image("", "RGB");
        if (const auto state = content.strings.find(kStateKey); state != content.strings.end())
            file.exposureEv = exposureOfState(state->second);
        if (layers) {
            file.motion = content.image("motion", "XYZ");
            file.depth = content.image("depth", "Z");
            if (file.depth.empty()) file.depth = content.image("", "Z");
        }
    }
    if (file.rgb.empty()) file.rgb = loadImage(path);
    return file;
}

std::string nameOf(const fs::path& path) { return path.filename().string(); }

/// Of two linear files.
ExposureUsed commonExposure(const fs::path& imagePath, const LoadedFile& image, const fs::path& referencePath,
                            const LoadedFile& reference) {
    ExposureUsed used{0, "no state", ""};
    if (reference.exposureEv) used = {*reference.exposureEv, "state of " + nameOf(referencePath), ""};
    else if (image.exposureEv) used = {*image.exposureEv, "state of " + nameOf(imagePath), ""};
    if (image.exposureEv && *image.exposureEv != used.ev)
        used.warning = fmt::format("{} was made at an exposure of {} EV, {} at {}; both are judged at {}",
                                   nameOf(imagePath), *image.exposureEv, nameOf(referencePath), used.ev, used.ev);
    return used;
}

/// Of a linear file and a picture as shown.
ExposureUsed exposureBesidePicture(const CompareOptions& options, const fs::path& linearPath, const LoadedFile& linear,
                                   const fs::path& picturePath) {
    ExposureUsed used;
    used.ev = options.exposureEv.value_or(linear.exposureEv.value_or(0));
    const char* from = options.exposureEv ? "--exposure for" : linear.exposureEv ? "state of" : "no state in";
    used.from = fmt::format("{} {}; {} stored as shown", from, nameOf(linearPath), nameOf(picturePath));
    used.warning =
        fmt::format("{} is a picture as shown: a tone curve in it and light beyond white count as differences from {}",
                    nameOf(picturePath), nameOf(linearPath));
    return used;
}

/// Decides on the exposure; of two files of which one is a picture, the picture's is taken back.
ExposureUsed matchExposures(const CompareOptions& options, const fs::path& imagePath, LoadedFile& image,
                            const fs::path& referencePath, LoadedFile& reference) {
    if (image.linear != reference.linear) {
        const ExposureUsed used = image.linear ? exposureBesidePicture(options, imagePath, image, referencePath)
                                               : exposureBesidePicture(options, referencePath, reference, imagePath);
        takeBackExposure(image.linear ? reference.rgb : image.rgb, used.ev);
        return used;
    }
    if (options.exposureEv) return {*options.exposureEv, "--exposure", ""};
    return image.linear ? commonExposure(imagePath, image, referencePath, reference)
                        : ExposureUsed{0, "stored as shown", ""};
}

}  // namespace

ComparedPair loadPair(const CompareOptions& options, const fs::path& imagePath, const fs::path& referencePath,
                      bool layers) {
    LoadedFile image = load(imagePath, false), reference = load(referencePath, layers);
    ComparedPair loaded;
    loaded.exposure = matchExposures(options, imagePath, image, referencePath, reference);
    ImagePair& pair = loaded.pair;
    pair.image = std::move(image.rgb), pair.reference = std::move(reference.rgb);
    if (!options.mask.empty()) pair.mask = luminanceMask(loadImage(options.mask));
    pair.exposureEv = loaded.exposure.ev;
    pair.settings = options.settings;
    if (!(pair.image.extent() == pair.reference.extent())) pair.prepare(imagePath.string());  // throws
    if (options.crop) {
        // Exposures belong to the whole reference, whichever part of it is looked at.
        if (!pair.settings.flipExposures) pair.settings.flipExposures = flipExposures(pair.reference);
        pair.image = croppedAs(options, std::move(pair.image));
        pair.reference = croppedAs(options, std::move(pair.reference));
        pair.mask = croppedAs(options, std::move(pair.mask));
    }
    if (layers) {
        loaded.image = pair.image, loaded.reference = pair.reference;
        loaded.motion = croppedAs(options, std::move(reference.motion));
        loaded.depth = croppedAs(options, std::move(reference.depth));
    }
    pair.prepare(imagePath.string());
    return loaded;
}

}  // namespace lumi
