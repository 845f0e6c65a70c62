#pragma once
#include "reference/reference.h"
#include "session/document.h"

namespace lumi {

/// What the document shows now (scene with its edits, camera, time, path settings, size, seed), as a converged image.
/// Views, modules and samples a frame play no part. Jitter::Auto is per pixel, as the accumulate module wants it.
ReferenceSpec referenceSpec(const Document& document);

/// Is `spec` one of what the document shows, whatever the seed of either?
bool isReferenceOf(const ReferenceSpec& spec, const Document& document);

}  // namespace lumi
