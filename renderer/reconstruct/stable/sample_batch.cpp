#include "reconstruct/stable/sample_batch.h"

#include <utility>

namespace lumi {

std::unique_ptr<SampleBatch> SpareBatches::take() {
    std::lock_guard lock(mutex_);
    if (spare_.empty()) return std::make_unique<SampleBatch>();
    auto batch = std::move(spare_.back());
    spare_.pop_back();
    return batch;
}

void SpareBatches::giveBack(std::unique_ptr<SampleBatch> batch) {
    std::lock_guard lock(mutex_);
    spare_.push_back(std::move(batch));
}

}  // namespace lumi
