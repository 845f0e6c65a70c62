#pragma once

namespace lumi {

/// Digest of the sources that decide what a sample is worth: base, math, image, params, scene, frame, trace and how
/// references add samples up; made by digest_sources.cmake when they are built.
extern const char* const kSourceDigest;
/// Compiler, its flags and Embree of this build.
extern const char* const kToolchain;

}  // namespace lumi
