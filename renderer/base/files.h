#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lumi {

/// Whole contents of a file. Throws Error(BadInput): missing, a directory, unreadable, or larger than `limitBytes`.
std::vector<uint8_t> readFile(const std::filesystem::path& path, uint64_t limitBytes = uint64_t(4) << 30);
std::string readTextFile(const std::filesystem::path& path, uint64_t limitBytes = uint64_t(1) << 30);

/// Writes to a temporary file beside `path`, then renames: a reader sees the old contents or the new, never a part.
/// Creates the folder if needed. Throws Error(Resources) if the disk is full, Error(Usage) if the path is not writable.
void writeFileAtomically(const std::filesystem::path& path, std::span<const uint8_t> bytes);
void writeFileAtomically(const std::filesystem::path& path, std::string_view text);

/// The same, but over no other file: under `path`, or `stem-1.ext`, `stem-2.ext`, ... : the first that is free once all
/// is written. Returns it.
std::filesystem::path writeNewFile(const std::filesystem::path& path, std::span<const uint8_t> bytes);

/// Creates the folder of `path` if needed. Throws as writeFileAtomically() would: nothing could be written there, the
/// name is too long.
void requireWritable(const std::filesystem::path& path);

/// What an interrupted write left: a part of `whole` (of a long name its beginning), by the process of that number.
struct Unfinished {
    std::filesystem::path whole;
    int process = 0;
};

/// By its name; nothing for any other file.
std::optional<Unfinished> unfinishedFile(const std::filesystem::path& path);

/// `path`, or `stem-1.ext`, `stem-2.ext`, ... : the first that does not exist, as far as can be seen.
std::filesystem::path unusedPath(const std::filesystem::path& path);

/// folder / name, normalised, where a file names another one; nothing if that leads out of `folder` (an absolute name,
/// too many `..`) or `name` holds a null byte. Looks at the text alone: symbolic links are followed later.
std::optional<std::filesystem::path> pathInside(const std::filesystem::path& folder, const std::string& name);

/// Lower-case extension with its dot, ".exr".
std::string lowerExtension(const std::filesystem::path& path);

/// 64-bit content digest (XXH3) as 16 hexadecimal digits.
std::string digest(std::span<const uint8_t> bytes);
uint64_t digest64(std::span<const uint8_t> bytes, uint64_t seed = 0);

}  // namespace lumi
