#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "math/vector.h"

namespace lumi {

/// Runs a program, arguments as they are, and returns what it wrote to standard output; empty if it failed or could not
/// be started. What it writes to standard error is dropped.
std::string outputOf(const std::vector<std::string>& command);

/// A folder of our own for files that another program reads; gone with the object.
class ScratchFolder {
public:
    ScratchFolder();
    ~ScratchFolder();
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

/// Peak resident bytes of `program render SCENE`; 0 if it could not be run.
uint64_t peakOfRender(const std::string& program, const std::filesystem::path& scene, Extent2 extent);

}  // namespace lumi
