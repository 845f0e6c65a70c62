#include "base/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <fstream>

#include "base/error.h"

namespace lumi {
namespace fs = std::filesystem;
namespace {

template <class Buffer>
Buffer readAll(const fs::path& path, uint64_t limitBytes) {
    std::error_code failure;
    const fs::file_status status = fs::status(path, failure);
    if (!fs::exists(status)) throwBadInput({"no such file", path.string(), "", ""});
    if (fs::is_directory(status)) throwBadInput({"is a directory", path.string(), "a file", ""});
    if (!fs::is_regular_file(status)) throwBadInput({"is not a regular file", path.string(), "a file", ""});
    const uint64_t size = fs::file_size(path, failure);
    if (failure) throwBadInput({"cannot be read (" + failure.message() + ")", path.string(), "", ""});
    if (size > limitBytes)
        throwBadInput({"file is too large", path.string(), fmt::format("at most {} bytes", limitBytes),
                       fmt::format("{} bytes", size)});
    std::ifstream file(path, std::ios::binary);
    if (!file) throwBadInput({std::string("cannot be opened (") + std::strerror(errno) + ")", path.string(), "", ""});
    Buffer bytes;
    bytes.resize(size);
    file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
    bytes.resize(static_cast<size_t>(std::max<std::streamsize>(file.gcount(), 0)));
    return bytes;
}

[[noreturn]] void throwWriteError(const fs::path& path, int code, const std::string& what = "cannot be written") {
    const ErrorKind kind = code == ENOSPC || code == EDQUOT ? ErrorKind::Resources : ErrorKind::Usage;
    throw Error(kind, {what + " (" + std::strerror(code) + ")", path.string(), "", ""});
}

void createFolderOf(const fs::path& path) {
    std::error_code failure;
    if (path.has_parent_path()) fs::create_directories(path.parent_path(), failure);
    if (failure) throwWriteError(path, failure.value(), "cannot be written: its folder cannot be created");
}

/// `<file>.<process>.<serial>.tmp`, which unfinishedFile() knows, a name for each call; of the file's own only so much
/// as file systems take.
fs::path temporaryBeside(const fs::path& path) {
    constexpr size_t kLongestName = 255;
    static std::atomic<uint32_t> serial{0};  // two threads may write one path
    const std::string tail = fmt::format(".{}.{}.tmp", getpid(), serial++), name = path.filename().string();
    return path.parent_path() / (name.substr(0, kLongestName - tail.size()) + tail);
}

/// All of `bytes` in a temporary file beside `path`, which is to take its name.
fs::path writeTemporary(const fs::path& path, std::span<const uint8_t> bytes) {
    createFolderOf(path);
    const fs::path temporary = temporaryBeside(path);
    const int file = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if (file < 0) throwWriteError(path, errno);
    const auto giveUp = [&](int code) {
        ::unlink(temporary.c_str());
        throwWriteError(path, code);
    };
    size_t written = 0;
    while (written < bytes.size()) {
        const ssize_t count = ::write(file, bytes.data() + written, bytes.size() - written);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) {
            const int code = errno;
            ::close(file);
            giveUp(code);
        }
        written += static_cast<size_t>(count);
    }
    if (::close(file) != 0) giveUp(errno);
    return temporary;
}

/// `path`, `stem-1.ext`, `stem-2.ext`, ...
fs::path numbered(const fs::path& path, int number) {
    if (number == 0) return path;
    return path.parent_path() / fmt::format("{}-{}{}", path.stem().string(), number, path.extension().string());
}

/// Gives `from` the name `to`, unless something has it: EEXIST then. 0 when done, else the error's number.
int renameToNew(const fs::path& from, const fs::path& to) {
    if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return 0;
    if (errno != EINVAL && errno != ENOSYS) return errno;
    // Some file systems cannot do it in one step.
    struct stat there {};
    if (::lstat(to.c_str(), &there) == 0) return EEXIST;
    return ::rename(from.c_str(), to.c_str()) == 0 ? 0 : errno;
}

/// 12 of ".12"; nothing if it is something else or too large.
std::optional<int> dottedNumber(const fs::path& extension) {
    const std::string& text = extension.native();
    int number = 0;
    if (text.size() < 2 || text[0] != '.' || text[1] == '-') return std::nullopt;
    const auto [end, code] = std::from_chars(text.data() + 1, text.data() + text.size(), number);
    return code == std::errc() && end == text.data() + text.size() ? std::optional(number) : std::nullopt;
}

}  // namespace

std::vector<uint8_t> readFile(const fs::path& path, uint64_t limitBytes) {
    return readAll<std::vector<uint8_t>>(path, limitBytes);
}

std::string readTextFile(const fs::path& path, uint64_t limitBytes) { return readAll<std::string>(path, limitBytes); }

void writeFileAtomically(const fs::path& path, std::span<const uint8_t> bytes) {
    const fs::path temporary = writeTemporary(path, bytes);
    if (::rename(temporary.c_str(), path.c_str()) == 0) return;
    const int code = errno;
    ::unlink(temporary.c_str());
    throwWriteError(path, code);
}

void writeFileAtomically(const fs::path& path, std::string_view text) {
    writeFileAtomically(path, std::span(reinterpret_cast<const uint8_t*>(text.data()), text.size()));
}

fs::path writeNewFile(const fs::path& path, std::span<const uint8_t> bytes) {
    const fs::path temporary = writeTemporary(path, bytes);
    for (int number = 0;; ++number) {
        const fs::path name = numbered(path, number);
        const int code = renameToNew(temporary, name);
        if (code == 0) return name;
        if (code == EEXIST) continue;
        ::unlink(temporary.c_str());
        throwWriteError(name, code);
    }
}

void requireWritable(const fs::path& path) {
    createFolderOf(path);
    struct stat there {};
    if (::lstat(path.c_str(), &there) != 0 && errno != ENOENT) throwWriteError(path, errno);
    const fs::path temporary = temporaryBeside(path);
    const int file = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
    if (file < 0) throwWriteError(path, errno);
    ::close(file);
    ::unlink(temporary.c_str());
}

std::optional<Unfinished> unfinishedFile(const fs::path& path) {
    if (path.extension() != ".tmp") return std::nullopt;
    // <whole>.<process>.<serial>.tmp
    const fs::path serialLast = path.stem(), processLast = serialLast.stem();
    const std::optional<int> process = dottedNumber(processLast.extension());
    if (!process || !dottedNumber(serialLast.extension()) || processLast.stem().empty()) return std::nullopt;
    return Unfinished{path.parent_path() / processLast.stem(), *process};
}

fs::path unusedPath(const fs::path& path) {
    for (int number = 0;; ++number) {
        std::error_code failure;  // what cannot be looked at is left to whoever writes it
        const fs::path candidate = numbered(path, number);
        if (!fs::exists(candidate, failure)) return candidate;
    }
}

std::optional<fs::path> pathInside(const fs::path& folder, const std::string& name) {
    const fs::path relative = fs::path(name).lexically_normal();
    const bool climbs = relative.is_absolute() || (!relative.empty() && *relative.begin() == "..");
    if (climbs || name.find('\0') != name.npos) return std::nullopt;
    return folder / relative;
}

std::string lowerExtension(const fs::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

uint64_t digest64(std::span<const uint8_t> bytes, uint64_t seed) {
    return XXH3_64bits_withSeed(bytes.data(), bytes.size(), seed);
}

std::string digest(std::span<const uint8_t> bytes) { return fmt::format("{:016x}", digest64(bytes)); }

}  // namespace lumi
