// Layout: 8 bytes of magic; version, length and digest of the head as 64-bit little-endian integers; the head as JSON,
// then the planes of each block (sum, left, scatter), of the tail and the depth as they lie in memory, then a 64-bit
// digest of all before it, piece by piece.
#include "reference/reference_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>

#include "base/error.h"
#include "base/files.h"
#include "base/memory.h"

namespace lumi {
namespace fs = std::filesystem;
using nlohmann::json;
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::string_view kMagic = "lumiref\n";
constexpr uint64_t kVersion = 1;
constexpr uint64_t kMostHeadBytes = 64 << 20;

template <class T>
std::span<const uint8_t> bytesOf(const T* data, size_t count) {
    return {reinterpret_cast<const uint8_t*>(data), count * sizeof(T)};
}
template <class T>
std::span<const uint8_t> bytesOf(const ImageOf<T>& image) {
    return bytesOf(image.data(), image.size());
}

json headOf(const ReferenceState& state) {
    json blocks = json::array(), ladder = json::array();
    for (const SampleBlock& block : state.blocks.blocks()) blocks.push_back({block.first, block.count});
    for (const auto& [samples, error] : state.ladder) ladder.push_back({samples, error});
    return {{"key", state.key},   {"width", state.extent.width}, {"height", state.extent.height},
            {"blocks", blocks},   {"tail", state.tailCount},     {"ladder", ladder},
            {"goal", state.goal}, {"note", state.note}};
}

[[noreturn]] void throwDamaged(const fs::path& path, const std::string& how) {
    throwBadInput({"is damaged (" + how + ")", path.string(), "a file of block sums that lumiscope wrote", ""});
}

/// A file that appears under its name only when all of it is on the disk.
class DurableFile {
public:
    explicit DurableFile(const fs::path& path)
        : path_(path), temporary_(path.string() + fmt::format(".{}.tmp", getpid())) {
        file_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
        if (file_ < 0) fail();
    }
    ~DurableFile() {
        if (file_ >= 0) ::close(file_);
        if (!done_) ::unlink(temporary_.c_str());
    }
    DurableFile(const DurableFile&) = delete;
    DurableFile& operator=(const DurableFile&) = delete;

    void write(std::span<const uint8_t> bytes) {
        digest_ = digest64(bytes, digest_);
        while (!bytes.empty()) {
            const ssize_t count = ::write(file_, bytes.data(), std::min<size_t>(bytes.size(), 1 << 30));
            if (count < 0 && errno == EINTR) continue;
            if (count < 0) fail();
            bytes = bytes.subspan(static_cast<size_t>(count));
        }
    }
    void finish() {
        const uint64_t digest = digest_;
        write(bytesOf(&digest, 1));
        if (::fsync(file_) != 0) fail();
        const int file = std::exchange(file_, -1);
        if (::close(file) != 0 || ::rename(temporary_.c_str(), path_.c_str()) != 0) fail();
        done_ = true;
        const fs::path folder = path_.has_parent_path() ? path_.parent_path() : ".";
        const int directory = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
        if (directory < 0) return;
        ::fsync(directory);  // the name itself; a file system that cannot still has the file
        ::close(directory);
    }

private:
    [[noreturn]] void fail() const {
        const int code = errno;
        const ErrorKind kind =
            code == ENOSPC || code == EDQUOT || code == EFBIG ? ErrorKind::Resources : ErrorKind::Usage;
        throw Error(kind, {std::string("cannot be written (") + std::strerror(code) + ")", path_.string(), "", ""});
    }

    const fs::path path_, temporary_;
    int file_ = -1;
    bool done_ = false;
    uint64_t digest_ = 0;
};

/// Reads pieces in order and keeps their digest.
class Reader {
public:
    explicit Reader(const fs::path& path) : path_(path) {
        std::error_code failure;
        if (!fs::is_regular_file(path, failure))
            throwBadInput({fs::exists(path, failure) ? "is not a file" : "no such file", path.string(), "", ""});
        size_ = fs::file_size(path, failure);
        file_.open(path, std::ios::binary);
        if (failure || !file_) throwBadInput({"cannot be opened", path.string(), "", ""});
    }
    template <class T>
    void read(T* data, size_t count) {
        file_.read(reinterpret_cast<char*>(data), static_cast<std::streamsize>(count * sizeof(T)));
        if (static_cast<size_t>(file_.gcount()) != count * sizeof(T)) throwDamaged(path_, "it ends early");
        digest_ = digest64(bytesOf(data, count), digest_);
    }
    template <class T>
    void read(ImageOf<T>& image) {
        read(image.data(), image.size());
    }
    uint64_t digest() const { return digest_; }
    uint64_t left() { return size_ - static_cast<uint64_t>(file_.tellg()); }

private:
    const fs::path& path_;
    std::ifstream file_;
    uint64_t size_ = 0, digest_ = 0;
};

struct Head {
    ReferenceState state;
    std::vector<SampleRange> blocks;
};

Head readHead(Reader& reader, const fs::path& path) {
    char magic[kMagic.size()];
    uint64_t numbers[3];
    if (reader.left() < sizeof(magic) + sizeof(numbers)) throwDamaged(path, "it ends early");
    reader.read(magic, sizeof(magic));
    if (std::string_view(magic, sizeof(magic)) != kMagic)
        throwBadInput({"holds no block sums of a reference", path.string(), "a file that `reference` wrote", ""});
    reader.read(numbers, 3);
    if (numbers[0] != kVersion)
        throwBadInput(
            {"was written by another version", path.string(), std::to_string(kVersion), std::to_string(numbers[0])});
    if (numbers[1] > kMostHeadBytes || numbers[1] > reader.left()) throwDamaged(path, "its head is too long");
    std::string text(numbers[1], '\0');
    reader.read(text.data(), text.size());
    if (digest64(bytesOf(text.data(), text.size())) != numbers[2])
        throwDamaged(path, "its head does not fit its digest");
    Head head;
    try {
        const json value = json::parse(text);
        ReferenceState& state = head.state;
        state.key = value.at("key").get<std::string>();
        state.extent = {value.at("width").get<int>(), value.at("height").get<int>()};
        state.tailCount = value.at("tail").get<uint64_t>();
        state.goal = value.at("goal").get<bool>();
        state.note = value.at("note").get<std::string>();
        for (const json& step : value.at("ladder"))
            state.ladder.emplace_back(step.at(0).get<uint64_t>(), step.at(1).get<double>());
        for (const json& block : value.at("blocks")) {
            const uint64_t first = block.at(0).get<uint64_t>();
            head.blocks.push_back({first, first + block.at(1).get<uint64_t>()});
        }
    } catch (const json::exception&) {
        throwDamaged(path, "its head cannot be read");
    }
    return head;
}

/// Are these blocks that SampleBlocks can hold, of an image of an acceptable size?
bool plausible(const Head& head) {
    const Extent2 extent = head.state.extent;
    if (extent.width < 1 || extent.height < 1 || extent.width > 16384 || extent.height > 16384) return false;
    if (head.state.tailCount >= kLeafSamples || (head.blocks.empty() && head.state.tailCount == 0)) return false;
    uint64_t end = head.blocks.empty() ? 0 : head.blocks.front().begin;
    for (const SampleRange& block : head.blocks) {
        if (block.begin != end || block.end <= block.begin || block.end > uint64_t(1) << 40) return false;
        if (block.count() % kLeafSamples != 0 || !std::has_single_bit(block.count()) ||
            block.begin % block.count() != 0)
            return false;
        end = block.end;
    }
    return true;
}

}  // namespace

void writeReferenceFile(const fs::path& path, const ReferenceState& state) {
    std::error_code failure;
    if (path.has_parent_path()) fs::create_directories(path.parent_path(), failure);
    const std::string head = headOf(state).dump();
    const uint64_t numbers[3] = {kVersion, head.size(), digest64(bytesOf(head.data(), head.size()))};
    DurableFile file(path);
    file.write(bytesOf(kMagic.data(), kMagic.size()));
    file.write(bytesOf(numbers, 3));
    file.write(bytesOf(head.data(), head.size()));
    for (const SampleBlock& block : state.blocks.blocks()) {
        file.write(bytesOf(block.sum));
        file.write(bytesOf(block.left));
        file.write(bytesOf(block.scatter));
    }
    if (state.tailCount > 0) file.write(bytesOf(state.tail));
    file.write(bytesOf(state.depth));
    file.finish();
}

ReferenceState readReferenceFile(const fs::path& path) {
    Reader reader(path);
    Head head = readHead(reader, path);
    if (!plausible(head)) throwDamaged(path, "its blocks make no sense");
    ReferenceState& state = head.state;
    const uint64_t pixels = static_cast<uint64_t>(state.extent.area());
    uint64_t expected = pixels * sizeof(float) + sizeof(uint64_t);
    if (state.tailCount > 0) expected += pixels * 3 * sizeof(double);
    for (const SampleRange& range : head.blocks) {
        const SampleBlock block{range.begin, range.count(), {}, {}, {}};
        expected +=
            pixels * (3 * sizeof(double) + (block.level() > 0 ? 3 * sizeof(float) : 0) +
                      static_cast<uint64_t>(std::min(block.level(), SampleBlock::kScatterDepths)) * sizeof(float));
    }
    if (reader.left() != expected) throwDamaged(path, "its length is wrong");
    checkMemory("reading " + path.string(), expected);
    std::vector<SampleBlock> blocks;
    for (const SampleRange& range : head.blocks) {
        SampleBlock block = SampleBlock::shaped(range, state.extent);
        reader.read(block.sum);
        reader.read(block.left);
        reader.read(block.scatter);
        blocks.push_back(std::move(block));
    }
    if (state.tailCount > 0) {
        state.tail.reset(state.extent, 3);
        reader.read(state.tail);
    }
    state.depth.reset(state.extent, 1);
    reader.read(state.depth);
    const uint64_t digest = reader.digest();
    uint64_t written = 0;
    reader.read(&written, 1);
    if (digest != written) throwDamaged(path, "its contents do not fit their digest");
    for (SampleBlock& block : blocks) state.blocks.add(std::move(block));
    return std::move(state);
}

ReferenceState readReferenceHead(const fs::path& path, SampleRange* range) {
    Reader reader(path);
    Head head = readHead(reader, path);
    if (!plausible(head)) throwDamaged(path, "its blocks make no sense");
    if (range)
        *range = head.blocks.empty() ? SampleRange() : SampleRange{head.blocks.front().begin, head.blocks.back().end};
    return std::move(head.state);
}

}  // namespace lumi
