#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "base/messages.h"
#include "reference/reference_file.h"

namespace lumi {

/// One process at a time, on one machine or several that share a file system; the system lets go of it when the holder
/// dies, however it dies.
class FileLock {
public:
    /// Waits; `waiting` is called a few times a second meanwhile. Throws Error(Interrupted) if stopped, Error(Usage) if
    /// the file cannot be made.
    FileLock(const std::filesystem::path& path, std::stop_token stop, const std::function<void()>& waiting);
    ~FileLock();
    FileLock(const FileLock&) = delete;
    FileLock& operator=(const FileLock&) = delete;

private:
    int file_ = -1;
};

/// The folder of one key in the cache: `<samples>.lumiref` for each number of samples that was asked for or that a
/// session came to. Files that are damaged or belong to another image are named in the log and never used.
class ReferenceCache {
public:
    ReferenceCache(const std::filesystem::path& folder, const std::string& keyText, MessageLog* log);

    std::filesystem::path fileOf(uint64_t samples) const;
    std::filesystem::path lockFile() const { return folder_ / "lock"; }
    /// Removes what killed processes were writing. Call with the lock held.
    void removeLeftovers() const;
    /// The state with most samples, but not more than `most`; nothing if there is none. Of `exactly` that many samples
    /// a state with a tail will do, else its tail is dropped.
    std::optional<ReferenceState> best(uint64_t most, bool exactly) const;
    /// What the files know of the ladder, ascending by samples.
    std::vector<std::pair<uint64_t, double>> ladder() const;
    /// Keeps `state`; the file of `earlier` samples, if it was nobody's goal, makes way.
    void save(const ReferenceState& state, uint64_t earlier) const;

private:
    std::vector<std::pair<uint64_t, std::filesystem::path>> files() const;  ///< most samples first
    void tell(const std::string& text) const;

    std::filesystem::path folder_;
    std::string keyText_;
    MessageLog* log_;
};

}  // namespace lumi
