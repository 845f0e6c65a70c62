#pragma once
#include <opensubdiv/far/primvarRefiner.h>

#include <filesystem>
#include <vector>

#include "base/files.h"
#include "scene/obj/cage.h"
#include "scene/subdivision.h"
#include "scene/subdivision_topology.h"

namespace lumi::test {

inline SubdivisionCage cageOf(const std::string& text, const std::string& where) {
    MessageLog log;
    return parseCage(text, where, log);
}

inline SubdivisionCage loadCage(const std::filesystem::path& path, MessageLog& log) {
    return parseCage(readTextFile(path), path.string(), log);
}

/// A value that OpenSubdiv's refiner interpolates.
struct CagePoint {
    Vec3 p{0};
    void Clear(void* = nullptr) { p = Vec3(0); }
    void AddWithWeight(const CagePoint& other, float weight) { p += weight * other.p; }
};

/// The cage's vertices after `levels` uniform refinements, and where they come to lie in the limit.
inline std::vector<CagePoint> refined(const SubdivisionCage& cage, int levels,
                                      std::vector<CagePoint>* limit = nullptr) {
    namespace Far = OpenSubdiv::Far;
    const auto refiner = makeRefiner(cage, "test");
    Far::TopologyRefiner::UniformOptions options(levels);
    options.fullTopologyInLastLevel = true;
    refiner->RefineUniform(options);
    const Far::PrimvarRefiner interpolate(*refiner);
    std::vector<CagePoint> points(cage.positions.size());
    for (size_t i = 0; i < points.size(); ++i) points[i].p = cage.positions[i];
    for (int level = 1; level <= levels; ++level) {
        std::vector<CagePoint> next(static_cast<size_t>(refiner->GetLevel(level).GetNumVertices()));
        interpolate.Interpolate(level, points, next);
        points = std::move(next);
    }
    if (limit) {
        limit->resize(points.size());
        interpolate.Limit(points, *limit);
    }
    return points;
}

}  // namespace lumi::test
