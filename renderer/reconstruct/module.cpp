#include "reconstruct/module.h"

namespace lumi {

Jitter Module::preferredJitter() const { return Jitter::PerFrame; }

const Image& Module::tap(const std::string&) const {
    static const Image none;
    return none;
}

}  // namespace lumi
