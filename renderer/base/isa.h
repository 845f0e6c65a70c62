#pragma once
#include <string>

namespace lumi {

/// Instruction sets that our kernels are compiled for: the x86-64 levels 2 (SSE4.2), 3 (AVX2, FMA) and 4
/// (AVX-512).
enum class Isa { Baseline, V3, V4 };

/// The best level that this machine has.
Isa detectIsa();

/// The level in use: detectIsa() unless setIsa() lowered it. Part of an image's state, since last bits differ.
Isa activeIsa();

/// Fixes the level. Throws Error(Usage) for a level the machine does not have.
void setIsa(Isa isa);

/// `baseline`, `v3` or `v4`; parseIsa throws Error(Usage) and lists them.
const char* isaName(Isa isa);
Isa parseIsa(const std::string& name);

/// Declares NAMETable(), which a file listed under KERNELS in lumi_library() defines once for each level, and
/// NAMEKernels(), the table of the level in use. Stands in namespace lumi, in the header that defines `Struct`.
#define LUMI_KERNELS(Struct, NAME)                   \
    namespace baseline {                             \
    const Struct& NAME##Table();                     \
    }                                                \
    namespace v3 {                                   \
    const Struct& NAME##Table();                     \
    }                                                \
    namespace v4 {                                   \
    const Struct& NAME##Table();                     \
    }                                                \
    inline const Struct& NAME##Kernels() {           \
        switch (activeIsa()) {                       \
            case Isa::V4: return v4::NAME##Table();  \
            case Isa::V3: return v3::NAME##Table();  \
            default: return baseline::NAME##Table(); \
        }                                            \
    }

}  // namespace lumi
