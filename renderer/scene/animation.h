#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "math/transform.h"

namespace lumi {

enum class Interpolation : uint8_t { Step, Linear, CubicSpline, CatmullRom };
enum class AnimatedProperty : uint8_t { Translation, Rotation, Scale, MorphWeights };

/// One animated property of one node. `values` holds, for each key, `components` floats (3, 4 as x y z w, or the number
/// of morph targets); CubicSpline holds in-tangent, value, out-tangent for each key (glTF's layout). Times ascend.
struct AnimationChannel {
    int node = -1;
    AnimatedProperty property = AnimatedProperty::Translation;
    Interpolation interpolation = Interpolation::Linear;
    int components = 3;
    std::vector<float> times;
    std::vector<float> values;

    /// Value at `time` in seconds into out[0, components). Before the first key its value, after the last the last's.
    /// Rotations come out unit.
    void evaluate(float time, float* out) const;
};

/// Channels that loop together: times wrap at `duration` (the longest channel's last key) if `loop`.
struct Animation {
    std::vector<AnimationChannel> channels;
    float duration = 0;
    bool loop = true;
    int index = -1;  ///< in the glTF that it comes from; -1: in none
};

}  // namespace lumi
