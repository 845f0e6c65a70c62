#pragma once
#include <string>

namespace lumi {

/// Instruction sets that our kernels are compiled for: the x86-64 levels 1 (SSE2), 3 (AVX2, FMA) and 4 (AVX-512).
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

/// A function table for each level, from a file listed under KERNELS in lumi_library():
///     const Kernels& kernels() { return selectKernels(baseline::table(), v3::table(), v4::table()); }
template <class Table>
const Table& selectKernels(const Table& baseline, const Table& v3, const Table& v4) {
    switch (activeIsa()) {
        case Isa::V4: return v4;
        case Isa::V3: return v3;
        default: return baseline;
    }
}

}  // namespace lumi
