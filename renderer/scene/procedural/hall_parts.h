#pragma once
#include "scene/procedural/mesh_tools.h"

namespace lumi::hall {

/// Pieces of the hall, each about its own origin. Material slots of the whole hall:
enum Slot : uint32_t { kStone, kTrim, kFloor, kVault, kColumn, kRoof, kWood, kMetal, kFlame };

/// A round column that stands on y = 0: square plinth, turned base, shaft with swelling (fluted if `flutes` > 0), and a
/// capital with two rows of leaves, volutes and an abacus. `radius` is the shaft's at the bottom.
Mesh column(float height, float radius, int flutes);

/// A square pier with base and cap mouldings.
Mesh pier(float height, float width);

/// A wall panel in the XY plane, `thickness` deep around z = 0, from x = -width/2 to width/2 and y = 0 to height, with
/// a round-headed opening: springing line at y = `spring`, radius `radius`; open at the bottom. An archivolt with a
/// keystone stands proud on the front, and on the back too if `bothFaces`.
Mesh archPanel(float width, float height, float thickness, float spring, float radius, bool bothFaces);

/// A flat rectangle in the plane of `right` and `up` from `corner`; the front is where right x up points.
Mesh flatPatch(const Vec3& corner, const Vec3& right, const Vec3& up);

/// A door of planks in the XY plane, facing +Z, that fills a round-headed opening.
Mesh archDoor(float spring, float radius);

/// One bay of balustrade along X, `width` long: plinth, turned balusters, rail.
Mesh balustrade(float width, float height, float balusterPitch);

/// A groin vault over a rectangle of width (X) by depth (Z), springing at y = 0, seen from below; crown at `rise`.
/// Ribs follow the groins; bands `band` wide, half of the arches between bays, follow the edges.
Mesh groinVault(float width, float depth, float rise, float band);

/// A cornice with dentils, `length` along X, standing out towards +Z from z = 0, its top at y = 0.
Mesh cornice(float length, float height, float reach, bool dentils);

/// A lantern that hangs from y = 0 by `drop` metres: an open cage (kMetal) with a glowing core (kFlame).
Mesh lantern(float drop, float size);

}  // namespace lumi::hall
