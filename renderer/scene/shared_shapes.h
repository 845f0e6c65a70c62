#pragma once
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <tuple>

#include "scene/posed_scene.h"

namespace lumi {

/// Equal for instances whose mesh deforms alike at one moment: mesh, skin, and the bytes of the weights that count.
using ShapeKey = std::tuple<const Mesh*, int, std::string>;
ShapeKey shapeKey(const Instance& instance, std::span<const float> weights, std::span<const Mat4> joints);

/// Deformed meshes of one moment. Instances of one mesh that its weights and joints bend alike share their vertices,
/// however many there are. For several threads.
class SharedShapes {
public:
    /// The mesh of an instance after deform(); `joints` are those of its skin, or none. Throws Error(Resources) where
    /// it takes too much memory.
    std::shared_ptr<const DeformedVertices> of(const Instance& instance, std::span<const float> weights,
                                               std::span<const Mat4> joints);

private:
    std::mutex mutex_;
    std::map<ShapeKey, std::shared_ptr<const DeformedVertices>> shapes_;
};

}  // namespace lumi
