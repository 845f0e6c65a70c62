#include "trace/settings.h"

namespace lumi {

void PathSettings::describe(ParameterVisitor& v) {
    v.integer("path.max-depth", maxDepth,
              {.label = "Path depth",
               .min = 1,
               .max = 64,
               .help = "Surfaces a path may scatter at; 1 is direct light only.",
               .redo = Redo::Samples});
    v.integer("path.max-diffuse-depth", maxDiffuseDepth,
              {.label = "Diffuse depth",
               .min = 0,
               .max = 64,
               .help = "Of these, how many scatterings may be diffuse.",
               .redo = Redo::Samples});
    v.integer("path.max-specular-depth", maxSpecularDepth,
              {.label = "Specular depth",
               .min = 0,
               .max = 64,
               .help = "Of these, how many may be specular reflections and transmissions.",
               .redo = Redo::Samples});
    v.choice("path.strategy", strategy,
             {.label = "Direct light",
              .options = {"mis", "light", "bsdf"},
              .help = "How light is found: multiple importance sampling (power heuristic), light samples alone, or "
                      "continued paths alone (with light samples for lights without extent).",
              .redo = Redo::Samples});
    v.choice("path.light-sampling", lightSampling,
             {.label = "Light choice",
              .options = {"power", "tree"},
              .help = "How a light is chosen: in proportion to power, or by its importance to the surface, from a tree "
                      "over all lights [Conty & Kulla 2018].",
              .redo = Redo::Samples});
    v.toggle("path.roulette", roulette,
             {.label = "Russian roulette",
              .help = "Ends dim paths at random and weights the others up.",
              .redo = Redo::Samples});
    v.when(roulette, [&] {
        v.integer("path.roulette-depth", rouletteDepth,
                  {.label = "Roulette depth",
                   .min = 0,
                   .max = 64,
                   .help = "Scatterings before roulette may end a path.",
                   .redo = Redo::Samples});
    });
    v.toggle("path.clamp", clamp,
             {.label = "Clamp",
              .help = "Limits each contribution after the first surface: less noise, lost energy.",
              .redo = Redo::Samples});
    v.when(clamp, [&] {
        v.number("path.clamp-radiance", clampRadiance,
                 {.label = "Clamp at",
                  .min = 0.01,
                  .max = 1000,
                  .scale = Scale::Log,
                  .unit = "W/(m^2 sr)",
                  .help = "Largest channel a contribution may have.",
                  .redo = Redo::Samples});
    });
    v.toggle(
        "path.multiple-scattering", multipleScattering,
        {.label = "Multiple scattering",
         .help = "Gives rough reflections what facets scatter more than once [Kulla & Conty 2017]; without it rough "
                 "metals darken.",
         .redo = Redo::Samples});
    v.toggle("path.regularize", regularize,
             {.label = "Regularize",
              .help = "Widens specular lobes after a scattering [Kaplanyan 2013].",
              .redo = Redo::Samples});
    v.when(regularize, [&] {
        v.choice("path.regularize-after", regularizeAfter,
                 {.label = "After",
                  .options = {"diffuse", "any"},
                  .help = "Which scattering comes first: a diffuse one, so that reflections in reflections stay sharp, "
                          "or any, as "
                          "[Schied17, sec. 3] has it.",
                  .redo = Redo::Samples});
        v.number("path.regularize-roughness", regularizeRoughness,
                 {.label = "Least roughness",
                  .min = 0.02,
                  .max = 1,
                  .help = "Roughness that lobes have at least after it, in the first sample.",
                  .redo = Redo::Samples});
        v.number(
            "path.regularize-decay", regularizeDecay,
            {.label = "Decay",
             .min = 0,
             .max = 0.5,
             .help =
                 "Sample n uses the least roughness times (n + 1)^-decay, so that the mean converges to the "
                 "image without regularization. Frames of a stream are samples too, so that it fades there as well: 0 "
                 "keeps its strength, which is what filters of a stream expect.",
             .redo = Redo::Samples});
    });
    v.choice("sampler.kind", sampler,
             {.label = "Sampler",
              .options = {"sobol", "halton", "independent", "blue-noise"},
              .help = "Owen-scrambled Sobol pairs, Halton that loops, independent numbers, or (for one "
                      "sample a frame) numbers by which neighbouring pixels err differently [Georgiev & Fajardo 2016].",
              .redo = Redo::Samples});
    v.when(sampler == SamplerKind::Halton, [&] {
        v.integer("sampler.halton-loop", haltonLoop,
                  {.label = "Halton loop",
                   .min = 1,
                   .max = 4096,
                   .scale = Scale::Log,
                   .help = "Samples after which the Halton sequence repeats.",
                   .redo = Redo::Samples});
    });
}

}  // namespace lumi
