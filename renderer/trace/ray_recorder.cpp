#include "trace/ray_recorder.h"

namespace lumi {

void RayRecorder::add(bool anyHit, Coherence coherence, std::span<const BatchRay> rays) {
    if (rays.empty()) return;
    std::lock_guard lock(mutex_);
    RecordedRays& own = threads_[std::this_thread::get_id()];
    own.calls.push_back({anyHit, coherence, own.rays.size(), rays.size()});
    own.rays.insert(own.rays.end(), rays.begin(), rays.end());
}

RecordedRays RayRecorder::take() {
    std::lock_guard lock(mutex_);
    RecordedRays all;
    for (auto& [id, own] : threads_) {
        for (RecordedRays::Call& call : own.calls) call.first += all.rays.size();
        all.calls.insert(all.calls.end(), own.calls.begin(), own.calls.end());
        all.rays.insert(all.rays.end(), own.rays.begin(), own.rays.end());
        own = {};
    }
    threads_.clear();
    return all;
}

}  // namespace lumi
