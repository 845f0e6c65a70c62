#pragma once
#include <memory>
#include <string>
#include <vector>

#include "image/image.h"
#include "math/transform.h"
#include "params/parameter.h"
#include "scene/texture.h"

namespace lumi {

enum class LightType : uint8_t { Point, Spot, Directional, Rectangle, Disk, Sphere };

/// True for the light types that have a body.
inline bool hasBody(LightType type) {
    return type == LightType::Rectangle || type == LightType::Disk || type == LightType::Sphere;
}

/// A light that is not a mesh. Its frame comes from a transform: emission goes along local -Z (spot, directional,
/// rectangle, disk), the rectangle spans local X and Y. Rectangles, disks and spheres are visible; they take
/// the transform's scale, the others none [KHR_lights_punctual].
struct Light {
    std::string name;
    LightType type = LightType::Point;
    Vec3 intensity{1};        ///< point, spot: W/sr
    Vec3 irradiance{1};       ///< directional: W/m^2 on a plane facing it
    Vec3 radiance{1};         ///< rectangle, disk, sphere: W/(m^2 sr), one-sided for the flat ones
    Texture radianceTexture;  ///< rectangle, disk: RGB (sRGB) times radiance, upright as seen from where it shines
    float range = kInfinity;  ///< point, spot: no light beyond; KHR_lights_punctual's fall-off window
    float innerConeDeg = 0, outerConeDeg = 45;  ///< spot: half-angles
    float angleDeg = 0;                         ///< directional: full angular diameter; 0 is a delta
    Vec2 size{1};                               ///< rectangle: full width and height, metres
    float radius = 0.5f;                        ///< sphere, disk: metres
    int node = -1;                              ///< index into Scene::nodes that carries it

    /// power (a factor on the emission) and what the type has: size, radius, angle-deg, cone angles, colour.
    void describe(ParameterVisitor&);
    float power = 1;  ///< user's factor on intensity, irradiance or radiance
    bool operator==(const Light&) const = default;
};

/// Light from infinitely far: an equirectangular image (image centre is -Z, top +Y), or a constant.
struct Environment {
    std::shared_ptr<const Image> image;  ///< RGB radiance, or null: `constant`
    std::string file;                    ///< for messages and the state; empty for built-in skies
    Vec3 constant{0};                    ///< radiance
    /// The built-in sky, in scenes that have no light: the image as long as `constant` is black.
    std::shared_ptr<const Image> standIn;
    float scale = 1;
    float rotateDeg = 0;  ///< about +Y, counter-clockwise seen from above
    bool visible() const { return image != nullptr || !isBlack(constant); }
    /// To be called once `constant` changes.
    void chooseStandIn() {
        if (standIn) image = isBlack(constant) ? standIn : nullptr;
    }

    void describe(ParameterVisitor&);
};

/// A smooth daylight gradient with a soft sun, mean radiance 1 over the sphere: for scenes without any light.
Image makeDefaultSky();

}  // namespace lumi
