#include "trace/carried_steps.h"

#include <algorithm>

namespace lumi {

unsigned carriedSteps(const ShutterTrack& track) {
    constexpr size_t kEnough = 32;
    const size_t moments = std::max(track.worldFromObject.size(), track.deformed.size()), intervals = moments - 1;
    const bool both = track.worldFromObject.size() > 1 && track.deformed.size() > 1;
    return static_cast<unsigned>(both ? (kEnough + intervals - 1) / intervals * intervals + 1 : moments);
}

CarriedStep::CarriedStep(const ShutterTrack& track, const Vec3* still, unsigned step, unsigned steps)
    : world_(track.worldFromObject[0]), from_(still), to_(still) {
    const float time = steps > 1 ? static_cast<float>(step) / static_cast<float>(steps - 1) : 0.0f;
    const size_t shapes = track.deformed.size();
    const auto placeAmong = [&](size_t count) {
        return count == steps ? TrackPlace{step, 0} : trackPlace(count, time);
    };
    const TrackPlace place = placeAmong(track.worldFromObject.size());
    world_ = place.fraction > 0 ? track.worldFromObjectAt(time) : track.worldFromObject[place.first];
    if (shapes == 0) return;
    const TrackPlace shape = placeAmong(shapes);
    fraction_ = shape.fraction;
    from_ = track.deformed[shape.first]->positions.data();
    if (fraction_ > 0) to_ = track.deformed[shape.first + 1]->positions.data();
}

}  // namespace lumi
