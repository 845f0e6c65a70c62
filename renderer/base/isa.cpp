#include "base/isa.h"

#include <atomic>

#include "base/error.h"

namespace lumi {
namespace {

std::atomic<Isa>& active() {
    static std::atomic<Isa> isa{detectIsa()};
    return isa;
}

// clang 14 knows features, not levels; these tell the levels apart on every processor that has them.
#ifdef __clang__
bool hasV3() {
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") &&
           __builtin_cpu_supports("bmi2");
}
bool hasV4() {
    return hasV3() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl");
}
#else
bool hasV3() { return __builtin_cpu_supports("x86-64-v3"); }
bool hasV4() { return __builtin_cpu_supports("x86-64-v4"); }
#endif

}  // namespace

Isa detectIsa() {
    __builtin_cpu_init();
    return hasV4() ? Isa::V4 : hasV3() ? Isa::V3 : Isa::Baseline;
}

Isa activeIsa() { return active(); }

void setIsa(Isa isa) {
    if (isa > detectIsa())
        throwUsage({std::string("this machine lacks the instruction set ") + isaName(isa), "--isa",
                    std::string("at most ") + isaName(detectIsa()), ""});
    active() = isa;
}

const char* isaName(Isa isa) {
    switch (isa) {
        case Isa::V4: return "v4";
        case Isa::V3: return "v3";
        default: return "baseline";
    }
}

Isa parseIsa(const std::string& name) {
    for (Isa isa : {Isa::Baseline, Isa::V3, Isa::V4})
        if (name == isaName(isa)) return isa;
    throwUsage({"unknown instruction set", "--isa", "baseline, v3 or v4", '"' + name + '"'});
}

}  // namespace lumi
