#pragma once
#include <memory>
#include <vector>

#include "trace/embree_scene.h"
#include "trace/light_shape.h"
#include "trace/lights.h"
#include "trace/scene_tables.h"

namespace lumi {

/// A posed scene bound for tracing: geometry, flat tables for shading, lights. Read-only while paths are traced.
struct TraceScene {
    std::shared_ptr<const PosedScene> posed;
    EmbreeScene embree;
    SceneTables tables;
    Lights lights;
};

}  // namespace lumi
