#pragma once
#include "scene/camera.h"

namespace lumi {

/// The camera's up direction, unit. An up vector without length gives the image's own: of +Y as nearly as the view
/// allows.
Vec3 unitUp(const Camera& camera);

/// The unit direction from eye to target; a camera that looks at its own eye looks along -Z.
Vec3 viewDirection(const Camera& camera);

}  // namespace lumi
