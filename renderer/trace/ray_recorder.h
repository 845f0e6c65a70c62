#pragma once
#include <map>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

#include "trace/packets.h"

namespace lumi {

/// Rays as they went to Embree, call by call, so that they can be traced again without anything around them.
struct RecordedRays {
    struct Call {
        bool anyHit = false;  ///< asked whether something is in the way, else what is nearest
        Coherence coherence = Coherence::Incoherent;
        size_t first = 0, count = 0;  ///< into `rays`
    };
    std::vector<BatchRay> rays;
    std::vector<Call> calls;
};

/// Listens to an EmbreeScene (Tracer::recordRays). Any thread; the calls of one thread stay together and in order.
class RayRecorder {
public:
    void add(bool anyHit, Coherence coherence, std::span<const BatchRay> rays);
    /// What was recorded since the last call, one thread after the other.
    RecordedRays take();

private:
    std::mutex mutex_;
    std::map<std::thread::id, RecordedRays> threads_;
};

}  // namespace lumi
