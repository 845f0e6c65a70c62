#pragma once
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <tuple>

#include "scene/posed_scene.h"

namespace lumi {

/// Deformed meshes of one moment. Instances of one mesh that its weights and joints bend alike share their vertices,
/// however many there are. For several threads.
class SharedShapes {
public:
    /// The mesh of an instance after deform(); `joints` are those of its skin, or none. Throws Error(Resources) where
    /// it takes too much memory.
    std::shared_ptr<const DeformedVertices> of(const Instance& instance, std::span<const float> weights,
                                               std::span<const Mat4> joints);

private:
    using Key = std::tuple<const Mesh*, int, std::string>;  // mesh, skin, bytes of the weights that count
    std::mutex mutex_;
    std::map<Key, std::shared_ptr<const DeformedVertices>> shapes_;
};

}  // namespace lumi
