#include "reference/reference_cache.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <map>
#include <thread>

#include "base/error.h"
#include "reference/reference.h"
#include "reference/reference_key.h"

namespace lumi {
namespace fs = std::filesystem;
namespace {

constexpr const char* kExtension = ".lumiref";

}  // namespace

FileLock::FileLock(const fs::path& path, std::stop_token stop, const std::function<void()>& waiting) {
    std::error_code failure;
    fs::create_directories(path.parent_path(), failure);
    file_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (file_ < 0) throwUsage({std::string("cannot be written (") + std::strerror(errno) + ")", path.string(), "", ""});
    while (::flock(file_, LOCK_EX | LOCK_NB) != 0) {
        if (errno != EWOULDBLOCK && errno != EINTR)
            return;  // a file system without locks: writes are whole all the same
        if (stop.stop_requested()) {
            ::close(file_);
            throw Error(ErrorKind::Interrupted, {"interrupted", "", "", ""});
        }
        waiting();
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
}

FileLock::~FileLock() { ::close(file_); }

fs::path defaultReferenceCache() {
    const auto variable = [](const char* name) {
        const char* value = std::getenv(name);
        return fs::path(value ? value : "");
    };
    fs::path base = variable("XDG_CACHE_HOME");
    if (!base.is_absolute()) {  // a relative one is to be ignored [XDG base directory specification]
        base = variable("HOME");
        if (base.empty()) return {};
        base /= ".cache";
    }
    return base / "lumiscope" / "references";
}

ReferenceCache::ReferenceCache(const fs::path& folder, const std::string& keyText, MessageLog* log)
    : folder_(folder), keyText_(keyText), log_(log) {}

fs::path ReferenceCache::fileOf(uint64_t samples) const { return folder_ / (std::to_string(samples) + kExtension); }

std::vector<std::pair<uint64_t, fs::path>> ReferenceCache::files() const {
    std::vector<std::pair<uint64_t, fs::path>> found;
    std::error_code failure;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_, failure)) {
        const fs::path& path = entry.path();
        if (path.extension() != kExtension) continue;
        const std::string stem = path.stem().string();
        uint64_t samples = 0;
        const auto [end, code] = std::from_chars(stem.data(), stem.data() + stem.size(), samples);
        if (code == std::errc() && end == stem.data() + stem.size()) found.emplace_back(samples, path);
    }
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    return found;
}

void ReferenceCache::removeLeftovers() const {
    std::error_code failure;
    std::vector<fs::path> leftovers;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_, failure))
        if (entry.path().extension() == ".tmp") leftovers.push_back(entry.path());
    for (const fs::path& path : leftovers) fs::remove(path, failure);
}

void ReferenceCache::tell(const std::string& text) const {
    if (log_) log_->warning(text);
}

std::optional<ReferenceState> ReferenceCache::best(uint64_t most, bool exactly) const {
    for (const auto& [samples, path] : files()) {
        if (samples > most) continue;
        try {
            ReferenceState state = readReferenceFile(path);
            if (state.key != keyText_ || state.samples() != samples ||
                (!state.blocks.empty() && state.blocks.range().begin != 0)) {
                const std::string difference = keyDifference(keyText_, state.key);
                tell(path.string() + ": belongs to another image" +
                     (difference.empty() ? "" : " (" + difference + ")") + "; it is not used");
                continue;
            }
            if (samples == most && exactly) return state;
            state.tail = {};
            state.tailCount = 0;
            return state;
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::BadInput) throw;
            tell(std::string(error.what()) + "; it is not used");
        }
    }
    return std::nullopt;
}

std::vector<std::pair<uint64_t, double>> ReferenceCache::ladder() const {
    std::map<uint64_t, double> steps;
    for (const auto& [samples, path] : files()) {
        try {
            const ReferenceState head = readReferenceHead(path);
            if (head.key == keyText_) steps.insert(head.ladder.begin(), head.ladder.end());
        } catch (const Error&) {
            // Told when the file itself is wanted.
        }
    }
    return {steps.begin(), steps.end()};
}

void ReferenceCache::save(const ReferenceState& state, uint64_t earlier) const {
    writeReferenceFile(fileOf(state.samples()), state);
    if (earlier == 0 || earlier >= state.samples()) return;
    try {
        if (readReferenceHead(fileOf(earlier)).goal) return;
    } catch (const Error&) {
        return;
    }
    std::error_code failure;
    fs::remove(fileOf(earlier), failure);
}

}  // namespace lumi
