// libFuzzer target of one loader: LUMI_FUZZ_EXTENSION chooses which. Errors are what loaders should throw; anything else
// that leaves them, a crash, a leak or a time-out is a finding.
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "base/error.h"
#include "base/files.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "image/decode.h"
#include "image/exr.h"
#include "image/hdr.h"
#include "image/png.h"
#include "scene/load.h"
#include "scene/obj/cage.h"
#include "scene/posed_scene.h"
#include "scene/subdivision.h"

namespace {
using namespace lumi;

const std::string kExtension = LUMI_FUZZ_EXTENSION;

/// A file of that content in memory-backed storage.
std::filesystem::path fileOf(std::span<const uint8_t> bytes) {
    static const std::filesystem::path path =
        std::filesystem::path("/dev/shm") / ("lumiscope-fuzz-" + std::to_string(getpid()) + kExtension);
    writeFileAtomically(path, bytes);
    return path;
}

void load(std::span<const uint8_t> bytes) {
    if (kExtension == ".exr") decodeExr(bytes, "fuzz.exr");
    else if (kExtension == ".hdr") decodeHdr(bytes, "fuzz.hdr");
    else if (kExtension == ".png") decodePng(bytes, "fuzz.png");
    else if (kExtension == ".jpg") decodeImage8(bytes, "fuzz.jpg");
    else if (kExtension == ".cage") {
        const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        tessellate(parseCage(text, "fuzz"), 2, "fuzz");
    } else {
        MessageLog log;
        poseScene(loadScene(fileOf(bytes), log), {0.3f, 0.3f, 0.2f});
    }
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
    setMemoryLimit(uint64_t(1) << 30);
    setThreadCount(1);
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    try {
        load({data, size});
    } catch (const Error&) {
    }
    return 0;
}
