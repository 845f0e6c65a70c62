#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "image/image.h"

namespace lumi {

enum class ExrType { Half, Float, Uint };

/// One channel of a file, row-major, top row first. Half and Float values are in `floats`, Uint values in `ids`.
struct ExrChannel {
    ExrType type = ExrType::Float;
    std::vector<float> floats;
    std::vector<uint32_t> ids;
};

/// The contents of a single-part OpenEXR file: channels by their full names ("R", "Z", "albedo.R", "motion.X",
/// "objectId", "svgf-historyLength.Y") and attributes.
struct ExrLayers {
    Extent2 extent;                              ///< display window
    std::map<std::string, ExrChannel> channels;  ///< in the order of the file: by name
    std::map<std::string, std::string> strings;  ///< string attributes; our state as JSON is under kStateKey
    std::optional<Mat4> worldToCamera, worldToNdc;
    float pixelAspect = 1;

    /// Adds the channels of `image` as `layer`.`letter`, one letter each of `letters` ("RGB", "XYZ", "Y", "Z"); an
    /// empty `layer` names them by the letter alone. An id image of one channel is named by the layer alone
    /// ("objectId"). The first image gives the extent; the others have the same.
    void add(std::string_view layer, std::string_view letters, const Image& image, ExrType type = ExrType::Float);
    void addIds(std::string_view layer, std::string_view letters, const IdImage& image);

    /// The channel of that name, or else the first whose canonicalChannel() it is, or null.
    const ExrChannel* find(std::string_view name) const;
    /// The layer's channels as one image, ids as numbers; empty if one is missing. Names resolve as in find().
    Image image(std::string_view layer, std::string_view letters) const;
};

/// Attribute (EXR) and text key (PNG) of the embedded state.
inline constexpr const char* kStateKey = "lumiscope";

/// Our name of a channel that another tool wrote: "Noisy Image.R" is noisy.R, "Ns.X" normal.X, "Combined.R" R, "id"
/// objectId (full table in exr_names.cpp). Names without an entry come back as they are.
std::string canonicalChannel(std::string_view name);

/// Bytes of the file: single part, scan lines, ZIP, no creation date; the same for any number of threads.
/// `halfColours` stores float channels whose letter is R, G, B or A as half. What is finite stays so: values beyond
/// kMostHalf become it, and `clamped`, if given, receives how many did.
inline constexpr float kMostHalf = 65504;
std::vector<uint8_t> encodeExr(const ExrLayers& layers, bool halfColours = false, size_t* clamped = nullptr);
void writeExr(const std::filesystem::path& path, const ExrLayers& layers, bool halfColours = false);

/// Reads every flat image part: scan lines or tiles (level 0), any compression, subsampled channels repeated. Pixels of
/// the display window outside the data window are 0. Channels of parts after the first are "<part>.<channel>" unless
/// they name a layer already. Throws Error(BadInput) naming the file, Error(Resources) beyond the memory limit.
ExrLayers decodeExr(std::span<const uint8_t> bytes, const std::string& name);
ExrLayers readExr(const std::filesystem::path& path);

}  // namespace lumi
