#pragma once
#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "scene/posed_scene.h"

namespace lumi {

/// Segments that the time of the open shutter is cut into at most.
constexpr size_t kMostShutterSegments = 64;

/// How far from the straight way something may stray between two moments, as a part of its size, or of the image's.
constexpr float kMostShutterStray = 1e-3f;

/// Parts of the time from `open` to `close` seconds, ascending and inside (0, 1), at which a motion shows that is not
/// straight: at keys, and between each two of them. At most one key counts in each of kMostShutterSegments equal spans:
/// what turns more often cannot be followed. Empty without keys in that time.
std::vector<float> shutterTurns(const Scene& scene, float open, float close);
/// The same of a camera: of its own keys, or of the scene's where a node carries it.
std::vector<float> shutterTurns(const Scene& scene, const SceneCamera& camera, float open, float close);

/// What `at(part)` gives at equally spaced parts from 0 (shutter open) to 1 (close), a power of two and one more of
/// them, so many that between two of them everything goes straight; at most kMostShutterSegments and one more.
/// `strays(a, truth, b, part)`: `truth`, at `part` of the way from a to b, does not lie on the straight way. It is
/// asked halfway between two moments, and at `turns`: what is back at its place at every halving shows there.
template <class At, class Strays>
auto straightSegments(std::span<const float> turns, const At& at, const Strays& strays) {
    std::vector<decltype(at(0.0f))> moments;
    moments.push_back(at(0.0f)), moments.push_back(at(1.0f));
    const auto straysAt = [&](float turn) {
        const TrackPlace place = trackPlace(moments.size(), turn);
        return strays(moments[place.first], at(turn), moments[place.first + 1], place.fraction);
    };
    while (moments.size() - 1 < kMostShutterSegments) {
        decltype(moments) finer;
        const size_t segments = 2 * (moments.size() - 1);
        bool straight = true;
        for (size_t i = 0; i + 1 < moments.size(); ++i) {
            auto middle = at(static_cast<float>(2 * i + 1) / static_cast<float>(segments));
            straight = straight && !strays(moments[i], middle, moments[i + 1], 0.5f);
            finer.push_back(moments[i]);
            finer.push_back(std::move(middle));
        }
        // A wave that crosses the straight way at its middle shows a quarter further on: two segments at least.
        if (straight && moments.size() > 2 && std::none_of(turns.begin(), turns.end(), straysAt)) break;
        finer.push_back(moments.back());
        moments = std::move(finer);
    }
    return moments;
}

}  // namespace lumi
