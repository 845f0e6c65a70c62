#include "base/isa.h"

#include <atomic>

#include "base/error.h"

namespace lumi {
namespace {

std::atomic<Isa>& active() {
    static std::atomic<Isa> isa{detectIsa()};
    return isa;
}

}  // namespace

Isa detectIsa() {
    __builtin_cpu_init();
    if (__builtin_cpu_supports("x86-64-v4")) return Isa::V4;
    if (__builtin_cpu_supports("x86-64-v3")) return Isa::V3;
    return Isa::Baseline;
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
