#include <Imath/ImathMatrix.h>
#include <OpenEXR/Iex.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "base/error.h"
#include "base/files.h"
#include "base/memory.h"
#include "image/exr.h"
#include "image/exr_streams.h"
#include "image/exr_threads.h"

namespace lumi {
namespace {

constexpr int64_t kMaxSide = 65536;
/// No compressor of the format packs more pixels into a byte than this; beyond it the header lies.
constexpr uint64_t kMaxRatio = 20000;

int64_t side(int low, int high) { return int64_t(high) - low + 1; }

Mat4 matrixOf(const Imath::M44f& m) {
    Mat4 result;
    std::memcpy(&result[0][0], &m[0][0], sizeof(float) * 16);
    return result;
}

/// A channel as the file has it: over the data window, perhaps with fewer columns and rows.
struct StoredChannel {
    ExrChannel values;
    int xSampling = 1, ySampling = 1;
    int columns = 0, rows = 0;

    void reset(const Imf::Channel& channel, const Imath::Box2i& data) {
        values.type = channel.type == Imf::UINT   ? ExrType::Uint
                      : channel.type == Imf::HALF ? ExrType::Half
                                                  : ExrType::Float;
        xSampling = channel.xSampling, ySampling = channel.ySampling;
        columns = static_cast<int>(side(data.min.x, data.max.x) / xSampling);
        rows = static_cast<int>(side(data.min.y, data.max.y) / ySampling);
        const size_t count = static_cast<size_t>(columns) * static_cast<size_t>(rows);
        if (values.type == ExrType::Uint) values.ids.resize(count);
        else values.floats.resize(count);
    }

    Imf::Slice slice(const Imath::Box2i& data) {
        const bool uint = values.type == ExrType::Uint;
        const void* base = uint ? static_cast<const void*>(values.ids.data()) : values.floats.data();
        return Imf::Slice::Make(uint ? Imf::UINT : Imf::FLOAT, base, data, sizeof(float),
                                sizeof(float) * static_cast<size_t>(columns), xSampling, ySampling);
    }

    /// The channel over the display window: 0 where the file has no pixel, samples repeated.
    ExrChannel placed(const Imath::Box2i& data, const Imath::Box2i& display) {
        if (data == display && xSampling == 1 && ySampling == 1) return std::move(values);
        ExrChannel result{values.type, {}, {}};
        const int64_t width = side(display.min.x, display.max.x), height = side(display.min.y, display.max.y);
        const auto count = static_cast<size_t>(width * height);
        if (values.type == ExrType::Uint) result.ids.resize(count);
        else result.floats.resize(count);
        for (int64_t y = std::max(display.min.y, data.min.y); y <= std::min(display.max.y, data.max.y); ++y) {
            for (int64_t x = std::max(display.min.x, data.min.x); x <= std::min(display.max.x, data.max.x); ++x) {
                const int64_t column = std::min<int64_t>((x - data.min.x) / xSampling, columns - 1);
                const int64_t row = std::min<int64_t>((y - data.min.y) / ySampling, rows - 1);
                const auto from = static_cast<size_t>(row * columns + column);
                const auto to = static_cast<size_t>((y - display.min.y) * width + (x - display.min.x));
                if (values.type == ExrType::Uint) result.ids[to] = values.ids[from];
                else result.floats[to] = values.floats[from];
            }
        }
        return result;
    }
};

/// One part while it is read.
struct Part {
    Imf::InputPart input;
    Imath::Box2i data, display;
    std::string prefix;  ///< "depth." for channels of a part named "depth"; empty for the first part
};

class Reader {
public:
    Reader(std::span<const uint8_t> bytes, const std::string& name) : bytes_(bytes), name_(name) {}

    ExrLayers read() {
        ExrByteReader stream(bytes_, name_);
        Imf::MultiPartInputFile file(stream, exrThreads());
        for (int index = 0; index < file.parts(); ++index) {
            const Imf::Header& header = file.header(index);
            if (header.hasType() && (header.type() == Imf::DEEPSCANLINE || header.type() == Imf::DEEPTILE)) continue;
            readAttributes(header);
            readPart(file, index);
        }
        if (layers_.channels.empty()) throwBadInput({"holds no flat image", name_, "", ""});
        return std::move(layers_);
    }

private:
    void readAttributes(const Imf::Header& header) {
        for (auto attribute = header.begin(); attribute != header.end(); ++attribute)
            if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute.attribute()))
                layers_.strings.emplace(attribute.name(), text->value());
        // The parts' own bookkeeping is not the author's.
        layers_.strings.erase("type");
        layers_.strings.erase("name");
        if (Imf::hasWorldToCamera(header)) layers_.worldToCamera = matrixOf(Imf::worldToCamera(header));
        if (Imf::hasWorldToNDC(header)) layers_.worldToNdc = matrixOf(Imf::worldToNDC(header));
        layers_.pixelAspect = header.pixelAspectRatio();
    }

    /// Refuses windows that cannot be meant before anything is allocated for them.
    void checkWindows(const Imf::Header& header, const Part& part) {
        uint64_t channels = 0;
        for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) ++channels;
        const Imath::Box2i* windows[] = {&part.data, &part.display};
        for (const Imath::Box2i* window : windows) {
            const int64_t width = side(window->min.x, window->max.x), height = side(window->min.y, window->max.y);
            if (width < 1 || height < 1 || width > kMaxSide || height > kMaxSide)
                throwBadInput({"has an impossible size", name_, fmt::format("1 to {} a side", kMaxSide),
                               fmt::format("{}x{}", width, height)});
            const uint64_t size = static_cast<uint64_t>(width * height) * channels * 4;
            if (size / kMaxRatio > bytes_.size())
                throwBadInput({"is too small for its size in pixels", name_, "",
                               fmt::format("{}x{} pixels in {} bytes", width, height, bytes_.size())});
            checkMemory(fmt::format("{}: {}x{} pixels in {} channels", name_, width, height, channels), size);
        }
        const Extent2 extent{static_cast<int>(side(part.display.min.x, part.display.max.x)),
                             static_cast<int>(side(part.display.min.y, part.display.max.y))};
        if (layers_.channels.empty()) layers_.extent = extent;
        if (!(layers_.extent == extent))
            throwBadInput({"parts have different display windows", name_,
                           fmt::format("{}x{}", layers_.extent.width, layers_.extent.height),
                           fmt::format("{}x{}", extent.width, extent.height)});
    }

    std::string fullName(const Part& part, const std::string& channel) const {
        if (part.prefix.empty() || channel.find('.') != std::string::npos) {
            if (!layers_.channels.contains(channel)) return channel;
        }
        return part.prefix + channel;
    }

    /// Reads all channels of a part at once, over its data window.
    void readPart(Imf::MultiPartInputFile& file, int index) {
        const Imf::Header& header = file.header(index);
        Part part{Imf::InputPart(file, index), header.dataWindow(), header.displayWindow(), ""};
        if (index > 0) part.prefix = header.hasName() ? header.name() + '.' : fmt::format("part{}.", index);
        checkWindows(header, part);

        std::map<std::string, StoredChannel> stored;
        Imf::FrameBuffer buffer;
        for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
            StoredChannel& target = stored[it.name()];
            target.reset(it.channel(), part.data);
            buffer.insert(it.name(), target.slice(part.data));
        }
        part.input.setFrameBuffer(buffer);
        part.input.readPixels(part.data.min.y, part.data.max.y);
        for (auto& [name, channel] : stored) {
            const std::string full = fullName(part, name);
            layers_.channels[full] = channel.placed(part.data, part.display);
            channel = {};
        }
    }

    std::span<const uint8_t> bytes_;
    std::string name_;
    ExrLayers layers_;
};

}  // namespace

bool ExrByteReader::read(char target[], int count) {
    const auto wanted = static_cast<uint64_t>(count);
    if (position_ > bytes_.size() || wanted > bytes_.size() - position_) throw Iex::InputExc("file ends early");
    std::memcpy(target, bytes_.data() + position_, wanted);
    position_ += wanted;
    return position_ < bytes_.size();
}

ExrLayers decodeExr(std::span<const uint8_t> bytes, const std::string& name) {
    try {
        return Reader(bytes, name).read();
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw Error(ErrorKind::Resources, {"not enough memory to read it", name, "", ""});
    } catch (const std::exception& failure) {
        std::string reason = failure.what();
        std::replace(reason.begin(), reason.end(), '\n', ' ');
        throwBadInput({"not a readable OpenEXR file (" + reason + ")", name, "", ""});
    }
}

ExrLayers readExr(const std::filesystem::path& path) { return decodeExr(readFile(path), path.string()); }

}  // namespace lumi
