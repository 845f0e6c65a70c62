#pragma once
#include <cstdint>

#include "base/memory.h"

namespace lumi::test {

/// Leaves the process `bytes` more than it has, and puts the limit back.
class MemoryLimit {
public:
    explicit MemoryLimit(uint64_t bytes) { setMemoryLimit(residentBytes() + bytes); }
    ~MemoryLimit() { setMemoryLimit(before_); }
    MemoryLimit(const MemoryLimit&) = delete;
    MemoryLimit& operator=(const MemoryLimit&) = delete;

private:
    uint64_t before_ = memoryLimit();
};

}  // namespace lumi::test
