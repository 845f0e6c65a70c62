#include "scene/file_warnings.h"

namespace lumi {
namespace {
constexpr size_t kMostWarnings = 200;  ///< different ones
}

void FileWarnings::warnWhole(const std::string& text) {
    {
        const std::lock_guard lock(mutex_);
        if (listed_.size() < kMostWarnings) listed_.insert(text);
        if (!listed_.contains(text)) {
            ++more_;
            return;
        }
    }
    log_.warning(text);
}

void FileWarnings::tellOfMore() const {
    if (more_ > 0) log_.warning(file_ + ": and " + std::to_string(more_) + " more faults");
}

}  // namespace lumi
