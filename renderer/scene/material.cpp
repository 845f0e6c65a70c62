#include "scene/material.h"

#include "scene/open_range.h"

namespace lumi {

void Material::describe(ParameterVisitor& v) {
    v.colour("base-color", baseColor,
             {.label = "Base colour",
              .max = 1,
              .help = "Diffuse albedo of dielectrics, reflectance of metals at normal incidence."});
    v.number("metallic", metallic,
             {.label = "Metallic", .help = "0 is a dielectric, 1 a metal.", .redo = Redo::Samples});
    v.number("roughness", roughness,
             {.label = "Roughness", .help = "Perceptual roughness; its square is GGX's alpha.", .redo = Redo::Samples});
    v.number("normal-scale", normalScale,
             {.label = "Normal map", .min = 0, .max = 4, .help = "Strength of the normal map.", .redo = Redo::Samples});
    v.colour("emission", emission, {.label = "Emission", .max = 1e6, .help = "Emitted radiance, W/(m^2 sr)."});
    v.choice("alpha-mode", alphaMode,
             {.label = "Alpha mode",
              .options = {"opaque", "mask", "blend"},
              .help = "How alpha is used: not at all, as a cut at alpha-cutoff, or as coverage.",
              .redo = Redo::Build});
    v.when(hasAlpha(), [&] {
        v.number("alpha", alpha, {.label = "Alpha", .help = "Coverage of the surface.", .redo = Redo::Samples});
    });
    v.when(alphaMode == AlphaMode::Mask, [&] {
        v.number("alpha-cutoff", alphaCutoff,
                 {.label = "Alpha cutoff",
                  .help = "The surface exists where alpha is at least this.",
                  .redo = Redo::Samples});
    });
    v.number("ior", ior,
             {.label = "Index of refraction",
              .min = 1,
              .max = 3,
              .help = "Of the dielectric against air.",
              .redo = Redo::Samples});
    v.number("specular", specular,
             {.label = "Specular",
              .help = "Weight of the dielectric reflection (KHR_materials_specular).",
              .redo = Redo::Samples});
    v.colour("specular-color", specularColor,
             {.label = "Specular colour", .max = 25, .help = "Tints the dielectric reflection at normal incidence."});
    describeTransmission(v);
    describeLayers(v);
    v.toggle("double-sided", doubleSided,
             {.label = "Double-sided", .help = "Both faces emit, and the camera sees both.", .redo = Redo::Samples});
}

void Material::describeTransmission(ParameterVisitor& v) {
    v.number(
        "transmission", transmission,
        {.label = "Transmission", .help = "Share of the diffuse base that transmits instead.", .redo = Redo::Samples});
    v.when(transmission > 0, [&] {
        v.number("thickness", thickness,
                 {.label = "Thickness",
                  .max = 1000,
                  .scale = Scale::Log,
                  .unit = "m",
                  .help = "0 is a thin wall that does not refract; any value above 0 makes the boundary of a solid.",
                  .redo = Redo::Samples});
        v.colour("attenuation-color", attenuationColor,
                 {.label = "Attenuation colour", .help = "What white becomes after the attenuation distance."});
        describeUpTo(
            v, "attenuation-distance", attenuationDistance,
            {.label = "Attenuation distance",
             .min = 1e-4,
             .max = 1e6,
             .scale = Scale::Log,
             .unit = "m",
             .help = "Path length in the medium that gives the attenuation colour; the largest absorbs nothing.",
             .redo = Redo::Samples});
    });
}

void Material::describeLayers(ParameterVisitor& v) {
    v.number("clearcoat", clearcoat,
             {.label = "Clearcoat", .help = "Share of the surface under a clear varnish.", .redo = Redo::Samples});
    v.when(clearcoat > 0, [&] {
        v.number(
            "clearcoat-roughness", clearcoatRoughness,
            {.label = "Clearcoat roughness", .help = "Perceptual roughness of the varnish.", .redo = Redo::Samples});
        v.number("clearcoat-normal-scale", clearcoatNormalScale,
                 {.label = "Clearcoat normal map",
                  .min = 0,
                  .max = 4,
                  .help = "Strength of the varnish's own normal map.",
                  .redo = Redo::Samples});
    });
    v.colour("sheen-color", sheenColor,
             {.label = "Sheen colour", .max = 1, .help = "Reflectance of fibres at grazing angles; black is none."});
    v.when(hasSheen(), [&] {
        v.number(
            "sheen-roughness", sheenRoughness,
            {.label = "Sheen roughness", .help = "0 shines at the rim alone, 1 everywhere.", .redo = Redo::Samples});
    });
    v.number("anisotropy", anisotropy,
             {.label = "Anisotropy", .help = "Stretches highlights along one direction.", .redo = Redo::Samples});
    v.when(anisotropy > 0, [&] {
        float degreesNow = degrees(anisotropyRotation);
        const float before = degreesNow;
        v.number("anisotropy-rotate-deg", degreesNow,
                 {.label = "Anisotropy direction",
                  .min = -360,
                  .max = 360,
                  .unit = "deg",
                  .help = "Of the stretch, counter-clockwise from the tangent.",
                  .redo = Redo::Samples});
        if (degreesNow != before) anisotropyRotation = radians(degreesNow);
    });
    v.number("iridescence", iridescence,
             {.label = "Iridescence", .help = "Share of the surface under a thin film.", .redo = Redo::Samples});
    v.when(iridescence > 0, [&] {
        v.number("iridescence-ior", iridescenceIor,
                 {.label = "Film index",
                  .min = 1,
                  .max = 3,
                  .help = "Index of refraction of the film.",
                  .redo = Redo::Samples});
        v.number("iridescence-thickness-min", iridescenceThicknessMin,
                 {.label = "Least film thickness",
                  .max = 10000,
                  .scale = Scale::Log,
                  .unit = "nm",
                  .help = "Where the thickness texture is 0.",
                  .redo = Redo::Samples});
        v.number("iridescence-thickness-max", iridescenceThicknessMax,
                 {.label = "Film thickness",
                  .max = 10000,
                  .scale = Scale::Log,
                  .unit = "nm",
                  .help = "Where the thickness texture is 1, and without one.",
                  .redo = Redo::Samples});
    });
}

}  // namespace lumi
