#include "base/memory.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>

#include "base/error.h"

namespace lumi {
namespace {

uint64_t machineBytes() {
    return static_cast<uint64_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<uint64_t>(sysconf(_SC_PAGESIZE));
}

std::atomic<uint64_t>& limit() {
    static std::atomic<uint64_t> bytes{machineBytes() / 4 * 3};
    return bytes;
}

/// Asking the system takes 7 microseconds, and a file may hold a million small things: while there is room, small
/// requests are taken from a credit that the last look has given, a 64th of that room.
constexpr uint64_t kSmall = 64 << 10, kLeastCharge = 1 << 10, kMostCredit = 4 << 20;

std::atomic<int64_t>& credit() {
    static std::atomic<int64_t> bytes{0};
    return bytes;
}

bool isOnCredit(uint64_t bytes) {
    const auto charge = static_cast<int64_t>(std::max(bytes, kLeastCharge));
    return bytes <= kSmall && credit().fetch_sub(charge) >= charge;
}

}  // namespace

void setMemoryLimit(uint64_t bytes) {
    limit() = bytes;
    credit() = 0;
}
uint64_t memoryLimit() { return limit(); }

void checkMemory(const std::string& what, uint64_t bytes) {
    if (isOnCredit(bytes)) return;
    const uint64_t used = residentBytes();
    if (bytes <= memoryLimit() && used <= memoryLimit() - bytes) {
        credit() = static_cast<int64_t>(std::min((memoryLimit() - bytes - used) / 64, kMostCredit));
        return;
    }
    throw Error(ErrorKind::Resources, {fmt::format("{} needs {}, which passes the memory limit of {} ({} in use)", what,
                                                   formatBytes(bytes), formatBytes(memoryLimit()), formatBytes(used)),
                                       "", "", ""});
}

uint64_t residentBytes() {
    long pages = 0;
    if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
        long total = 0;
        if (std::fscanf(file, "%ld %ld", &total, &pages) != 2) pages = 0;
        std::fclose(file);
    }
    return static_cast<uint64_t>(pages) * static_cast<uint64_t>(sysconf(_SC_PAGESIZE));
}

uint64_t peakResidentBytes() {
    // Of this program's own memory: ru_maxrss begins at the peak of the program that started it.
    unsigned long long kib = 0;
    if (std::FILE* file = std::fopen("/proc/self/status", "r")) {
        char line[256];
        while (std::fgets(line, sizeof line, file) && std::sscanf(line, "VmHWM: %llu", &kib) != 1) {
        }
        std::fclose(file);
    }
    if (kib > 0) return kib * 1024;
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<uint64_t>(usage.ru_maxrss) * 1024;
}

std::string formatBytes(uint64_t bytes) {
    const char* units[] = {"B", "KiB", "MiB", "GiB", "TiB", "PiB", "EiB"};
    double value = static_cast<double>(bytes);
    int unit = 0;
    while (value >= 1024 && unit < 6) value /= 1024, ++unit;
    return unit == 0 ? fmt::format("{} B", bytes) : fmt::format("{:.1f} {}", value, units[unit]);
}

uint64_t parseBytes(const std::string& text, const std::string& where) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    std::string unit = end;
    double scale = -1;
    if (unit == "%") scale = static_cast<double>(machineBytes()) / 100;
    if (unit == "" || unit == "B") scale = 1;
    if (unit == "K" || unit == "KB" || unit == "KiB") scale = 1024.0;
    if (unit == "M" || unit == "MB" || unit == "MiB") scale = 1024.0 * 1024;
    if (unit == "G" || unit == "GB" || unit == "GiB") scale = 1024.0 * 1024 * 1024;
    if (end == text.c_str() || scale < 0 || !(value > 0) || !(value * scale < 9e18))
        throwUsage({"not a size", where, "a number with K, M, G or %", '"' + text + '"'});
    return static_cast<uint64_t>(value * scale);
}

}  // namespace lumi
