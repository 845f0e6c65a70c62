#pragma once
#include <opensubdiv/far/topologyRefiner.h>

#include <memory>
#include <string>

#include "scene/subdivision.h"

namespace lumi {

/// OpenSubdiv's topology of a cage, tags included, not refined yet. Throws Error(BadInput) headed by `where`.
std::unique_ptr<OpenSubdiv::Far::TopologyRefiner> makeRefiner(const SubdivisionCage& cage, const std::string& where);

}  // namespace lumi
