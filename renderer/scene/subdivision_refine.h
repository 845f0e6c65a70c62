#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "scene/subdivision.h"

namespace lumi {

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
