#include <Imath/ImathMatrix.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <half.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>

#include "base/error.h"
#include "base/files.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "image/exr.h"
#include "image/exr_streams.h"
#include "image/exr_threads.h"

namespace lumi {
namespace {

bool isColour(const std::string& name) {
    const size_t dot = name.rfind('.');
    const std::string letter = dot == std::string::npos ? name : name.substr(dot + 1);
    return letter == "R" || letter == "G" || letter == "B" || letter == "A";
}

/// EXR transforms row vectors: its matrix is the transpose of ours, so that both have the same order in memory.
Imath::M44f exrMatrix(const Mat4& m) {
    Imath::M44f result;
    std::memcpy(&result[0][0], &m[0][0], sizeof(float) * 16);
    return result;
}

Imf::Header makeHeader(const ExrLayers& layers) {
    Imf::Header header(layers.extent.width, layers.extent.height, layers.pixelAspect, Imath::V2f(0, 0), 1,
                       Imf::INCREASING_Y, Imf::ZIP_COMPRESSION);
    for (const auto& [name, value] : layers.strings) header.insert(name, Imf::StringAttribute(value));
    if (layers.worldToCamera) Imf::addWorldToCamera(header, exrMatrix(*layers.worldToCamera));
    if (layers.worldToNdc) Imf::addWorldToNDC(header, exrMatrix(*layers.worldToNdc));
    // Rec.709 primaries and white, said outright.
    Imf::addChromaticities(header, Imf::Chromaticities());
    return header;
}

bool isBeyondHalf(float value) { return std::isfinite(value) && std::abs(value) > kMostHalf; }

half clampedHalf(float value) { return half(isBeyondHalf(value) ? std::copysign(kMostHalf, value) : value); }

}  // namespace

void ExrByteWriter::write(const char bytes[], int count) {
    const uint64_t end = position_ + static_cast<uint64_t>(count);
    if (end > bytes_.size()) bytes_.resize(end);
    std::copy(bytes, bytes + count, bytes_.begin() + static_cast<std::ptrdiff_t>(position_));
    position_ = end;
}

std::vector<uint8_t> encodeExr(const ExrLayers& layers, bool halfColours, size_t* clamped) {
    assert(!layers.extent.empty() && !layers.channels.empty());
    const auto width = static_cast<size_t>(layers.extent.width);
    Imf::Header header = makeHeader(layers);
    Imf::FrameBuffer buffer;
    std::vector<std::vector<half>> halves;  // of the channels stored as half
    halves.reserve(layers.channels.size());
    if (clamped) *clamped = 0;
    for (const auto& [name, channel] : layers.channels) {
        assert((channel.type == ExrType::Uint ? channel.ids.size() : channel.floats.size()) ==
               static_cast<size_t>(layers.extent.area()));
        const bool asHalf =
            channel.type == ExrType::Half || (halfColours && channel.type == ExrType::Float && isColour(name));
        const char* data = nullptr;
        Imf::PixelType type = Imf::FLOAT;
        if (channel.type == ExrType::Uint) {
            type = Imf::UINT;
            data = reinterpret_cast<const char*>(channel.ids.data());
        } else if (asHalf) {
            type = Imf::HALF;
            checkMemory("half channel " + name, channel.floats.size() * sizeof(half));
            std::vector<half>& converted = halves.emplace_back(channel.floats.size());
            std::transform(channel.floats.begin(), channel.floats.end(), converted.begin(), clampedHalf);
            if (clamped)
                *clamped +=
                    static_cast<size_t>(std::count_if(channel.floats.begin(), channel.floats.end(), isBeyondHalf));
            data = reinterpret_cast<const char*>(converted.data());
        } else {
            data = reinterpret_cast<const char*>(channel.floats.data());
        }
        const size_t size = type == Imf::HALF ? 2 : 4;
        header.channels().insert(name, Imf::Channel(type));
        buffer.insert(name, Imf::Slice(type, const_cast<char*>(data), size, size * width));
    }
    ExrByteWriter stream("image.exr");
    try {
        Imf::OutputFile file(stream, header, exrThreads());
        file.setFrameBuffer(buffer);
        file.writePixels(layers.extent.height);
    } catch (const std::exception& failure) {
        throw Error(ErrorKind::Usage,
                    {std::string("cannot be stored as OpenEXR (") + failure.what() + ")", "", "", ""});
    }
    return stream.take();
}

void writeExr(const std::filesystem::path& path, const ExrLayers& layers, bool halfColours) {
    writeFileAtomically(path, encodeExr(layers, halfColours));
}

}  // namespace lumi
