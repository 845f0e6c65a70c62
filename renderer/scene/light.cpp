#include "scene/light.h"

#include "scene/open_range.h"

namespace lumi {

void Light::describe(ParameterVisitor& v) {
    v.number("power", power,
             {.label = "Power",
              .min = 0,
              .max = 1e4,
              .scale = Scale::Log,
              .help = "Factor on all that the light emits.",
              .redo = Redo::Samples});
    const bool isFlat = type == LightType::Rectangle, isRound = type == LightType::Sphere || type == LightType::Disk;
    const bool isPoint = type == LightType::Point, isSpot = type == LightType::Spot;
    v.when(isPoint || isSpot, [&] {
        v.colour("intensity", intensity, {.label = "Intensity", .max = 1e9, .help = "Radiant intensity, W/sr."});
        describeUpTo(v, "range", range,
                     {.label = "Range",
                      .min = 1e-3,
                      .max = 1e6,
                      .scale = Scale::Log,
                      .unit = "m",
                      .help = "No light reaches farther; the largest is unlimited.",
                      .redo = Redo::Samples});
    });
    v.when(isSpot, [&] {
        v.number("inner-cone-deg", innerConeDeg,
                 {.label = "Inner cone",
                  .min = 0,
                  .max = 90,
                  .unit = "deg",
                  .help = "Half-angle of full intensity.",
                  .redo = Redo::Samples});
        v.number("outer-cone-deg", outerConeDeg,
                 {.label = "Outer cone",
                  .min = 0,
                  .max = 90,
                  .unit = "deg",
                  .help = "Half-angle at which the intensity reaches zero.",
                  .redo = Redo::Samples});
    });
    v.when(type == LightType::Directional, [&] {
        v.colour("irradiance", irradiance,
                 {.label = "Irradiance", .max = 1e6, .help = "On a plane that faces the light, W/m^2."});
        v.number("angle-deg", angleDeg,
                 {.label = "Angular size",
                  .min = 0,
                  .max = 90,
                  .scale = Scale::Log,
                  .unit = "deg",
                  .help = "Full angular diameter; 0 casts hard shadows, the sun has 0.53.",
                  .redo = Redo::Samples});
    });
    v.when(isFlat || isRound, [&] {
        v.colour("radiance", radiance, {.label = "Radiance", .max = 1e6, .help = "Emitted radiance, W/(m^2 sr)."});
    });
    v.when(isFlat, [&] {
        v.number("width", size.x,
                 {.label = "Width",
                  .min = 1e-4,
                  .max = 1e4,
                  .scale = Scale::Log,
                  .unit = "m",
                  .help = "Along the light's X axis.",
                  .redo = Redo::Build});
        v.number("height", size.y,
                 {.label = "Height",
                  .min = 1e-4,
                  .max = 1e4,
                  .scale = Scale::Log,
                  .unit = "m",
                  .help = "Along the light's Y axis.",
                  .redo = Redo::Build});
    });
    v.when(isRound, [&] {
        v.number("radius", radius,
                 {.label = "Radius",
                  .min = 1e-4,
                  .max = 1e4,
                  .scale = Scale::Log,
                  .unit = "m",
                  .help = "Of the sphere or disk.",
                  .redo = Redo::Build});
    });
}

void Environment::describe(ParameterVisitor& v) {
    v.number("scale", scale,
             {.label = "Scale",
              .min = 0,
              .max = 1e4,
              .scale = Scale::Log,
              .help = "Factor on the environment's radiance.",
              .redo = Redo::Samples});
    v.number("rotate-deg", rotateDeg,
             {.label = "Rotation",
              .min = -360,
              .max = 360,
              .unit = "deg",
              .help = "About +Y, counter-clockwise seen from above.",
              .redo = Redo::Samples});
    v.when(image == nullptr || standIn, [&] {
        v.colour(
            "constant", constant,
            {.label = "Radiance",
             .max = 1e6,
             .help = "Uniform radiance from all directions where there is no image; any but black takes the place of "
                     "the built-in sky."});
    });
}

}  // namespace lumi
