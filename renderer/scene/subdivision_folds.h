#pragma once
#include <opensubdiv/far/topologyRefiner.h>

namespace lumi {

// What OpenSubdiv 3.5 must not be given, seen in its source and with it compiled for the address sanitizer. All of it
// is avoided by refinement (subdivision_refine.h).
//
// A fold is a vertex with a closed ring of two faces. Faces with a fold have their patch built in a branch of its own:
// - If such a face also has an open edge (a boundary, or one where more than two faces meet or two that go along it in
//   the same direction), the sharpness of its open edges is written over the first sharp edges gathered around it, and
//   as many entries at the end are read that nobody wrote, as indices of vertices (its pull request 1301). One level of
//   refinement leaves a fold on quads all of whose edges are closed. The exception is a face with an edge from a vertex
//   to itself: its halves join the same vertices, so their middle becomes a fold, on faces that may be open; a second
//   level mends that. Texture coordinates have folds and open edges of their own.
// - A fold with one infinitely sharp edge reads and writes out of bounds (1336): a dart's edge that is sharp but not
//   infinitely so avoids it.
// - A patch with a fold must not be shared through the surface cache (1353).
//
// Creases around a face are gathered into a buffer with as many entries as the patch has vertices. Between triangles
// there may be more: a face whose corners have n edges in all has up to n - 3 creases but only n - 6 vertices. The
// buffer overflows where it does not lie on the stack with room to spare. Between quads there are always enough.

/// True if the vertex, or a fan of faces at a non-manifold one, is a fold.
bool isFold(const OpenSubdiv::Far::TopologyLevel& level, int vertex);

/// True if any vertex is a fold.
bool hasFolds(const OpenSubdiv::Far::TopologyLevel& level);

/// True if a face has a fold and an open edge, by its vertices or by a face-varying channel.
bool hasOpenFolds(const OpenSubdiv::Far::TopologyLevel& level);

/// True if the creases around a face among triangles may be too many for their buffer.
bool hasCrowdedCreases(const OpenSubdiv::Far::TopologyLevel& level);

}  // namespace lumi
