#pragma once
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "base/error.h"
#include "base/files.h"
#include "base/memory.h"
#include "base/parallel.h"

namespace lumi::fuzz {

using Bytes = std::span<const uint8_t>;

/// What every target is: given any bytes, good work or an Error. Anything else that is let out, a crash, a leak or a
/// time-out is a finding.
void load(Bytes bytes);

inline std::string text(Bytes bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

/// A file of that content in memory-backed storage, in a folder of the process's own.
inline std::filesystem::path fileOf(Bytes bytes, const std::string& name) {
    static const std::filesystem::path folder = [] {
        const auto own = std::filesystem::path("/dev/shm") / ("lumiscope-fuzz-" + std::to_string(getpid()));
        std::filesystem::create_directories(own);
        return own;
    }();
    writeFileAtomically(folder / name, bytes);
    return folder / name;
}

}  // namespace lumi::fuzz

extern "C" int LLVMFuzzerInitialize(int*, char***) {
    lumi::setMemoryLimit(uint64_t(1) << 30);
    lumi::setThreadCount(1);
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    try {
        lumi::fuzz::load({data, size});
    } catch (const lumi::Error&) {
    }
    return 0;
}
