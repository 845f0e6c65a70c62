#pragma once
#include <opensubdiv/far/topologyRefiner.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "scene/subdivision.h"

namespace lumi {

// A fold is a vertex with a closed ring of two faces. OpenSubdiv 3.5 builds the patches of faces with a fold in a
// branch of its own, which reads and writes out of bounds where such a face has a boundary and a semi-sharp edge (its
// pull request 1301), at a fold with one infinitely sharp edge (1336), and where the patch is shared through the
// surface cache (1353). One level of refinement leaves every fold on quads without boundary, which avoids the first; a
// dart's edge that is sharp but not infinitely so avoids the second, no cache the third.

/// True if a vertex of the level, or a fan of faces at a non-manifold one, is a fold.
bool hasFolds(const OpenSubdiv::Far::TopologyLevel& level);

/// A cage after one step of its own subdivision, and where it came from.
struct RefinedCage {
    struct Row {
        std::vector<std::pair<uint32_t, float>> weights;  ///< (vertex of the coarse cage, weight)
    };
    SubdivisionCage cage;               ///< its limit surface is the coarse cage's; quads only; no darts at folds
    std::vector<Row> vertices;          ///< of each refined vertex
    std::vector<uint32_t> parentFace;   ///< of each refined face
    std::vector<uint32_t> childOfFace;  ///< its number among its parent's children
    std::vector<uint32_t> parentSize;   ///< corners of the parent
};

/// Refines `cage` once by its own rules [OpenSubdiv 3.5, Far]. Faces without a limit surface become holes. Throws as
/// makeRefiner() does.
RefinedCage refineOnce(const SubdivisionCage& cage, const std::string& where);

}  // namespace lumi
