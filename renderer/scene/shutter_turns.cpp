#include <cmath>
#include <optional>

#include "scene/shutter_segments.h"

namespace lumi {
namespace {

/// Where between two keys is looked: not halfway, where a wave may cross the straight way.
constexpr float kBetweenKeys = 0.38f;

/// The first key found in each of equal spans of the open shutter, as its part of the whole.
class KeysInShutter {
public:
    KeysInShutter(float open, float close) : open_(open), length_(double(close) - open), parts_(kMostShutterSegments) {}

    /// `times` ascend. They count from `start` seconds on.
    void add(std::span<const float> times, double start = 0) {
        const auto timeOf = [&](size_t span) {
            return open_ + length_ * static_cast<double>(span) / static_cast<double>(parts_.size()) - start;
        };
        for (auto key = std::upper_bound(times.begin(), times.end(), timeOf(0));
             key != times.end() && *key < timeOf(parts_.size());) {
            const double part = (*key - timeOf(0)) / length_;
            const size_t span =
                std::min(static_cast<size_t>(part * static_cast<double>(parts_.size())), parts_.size() - 1);
            if (!parts_[span]) parts_[span] = static_cast<float>(part);
            key = std::lower_bound(key + 1, times.end(), timeOf(span + 1));
        }
    }
    void add(const Animation& animation) {
        // The times at which its rounds start that the shutter sees.
        double first = 0, last = 0;
        if (animation.loop && animation.duration > 0) {
            first = std::floor(open_ / animation.duration), last = std::floor((open_ + length_) / animation.duration);
            if (last - first > static_cast<double>(parts_.size())) return;
        }
        for (double round = first; round <= last; ++round)
            for (const AnimationChannel& channel : animation.channels) add(channel.times, round * animation.duration);
    }
    std::vector<float> turns() const {
        std::vector<float> turns;
        float before = 0;
        for (const std::optional<float>& part : parts_) {
            if (!part) continue;
            turns.push_back(glm::mix(before, *part, kBetweenKeys));
            turns.push_back(before = *part);
        }
        if (!turns.empty()) turns.push_back(glm::mix(before, 1.0f, kBetweenKeys));
        return turns;
    }

private:
    double open_ = 0, length_ = 0;
    std::vector<std::optional<float>> parts_;  ///< for each span
};

}  // namespace

std::vector<float> shutterTurns(const Scene& scene, float open, float close) {
    KeysInShutter keys(open, close);
    for (const Animation& animation : scene.animations) keys.add(animation);
    return keys.turns();
}

std::vector<float> shutterTurns(const Scene& scene, const SceneCamera& camera, float open, float close) {
    if (camera.node >= 0) return shutterTurns(scene, open, close);
    std::vector<float> times;
    for (const SceneCamera::Key& key : camera.keys) times.push_back(key.time);
    KeysInShutter keys(open, close);
    keys.add(times);
    return keys.turns();
}

}  // namespace lumi
