#pragma once
#include <cstdint>
#include <optional>
#include <vector>

namespace lumi {

/// The highest resident size of the process since this was made, above what it had then.
class MemoryPeak {
public:
    MemoryPeak();
    /// Nothing where the system does not tell.
    std::optional<uint64_t> bytes() const;

private:
    bool good_ = false;
    uint64_t before_ = 0;
};

/// Reads `bytes` bytes of memory once on all threads: the least that any filter over so much data can take.
class MemoryStream {
public:
    explicit MemoryStream(size_t bytes);
    void run();
    /// Of what was read, so that no reading is left out.
    double sum() const { return sum_; }

private:
    std::vector<float> values_;
    std::vector<double> sums_;
    double sum_ = 0;
};

}  // namespace lumi
