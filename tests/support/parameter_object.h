#pragma once
#include "params/parameter.h"

namespace lumi::test {

enum class Filter { Box, Gauss, Catmull };

/// One parameter of each type, and a nested `when`.
struct SampleObject {
    float alpha = 0.2f;
    int levels = 5;
    bool temporal = true;
    Filter filter = Filter::Gauss;
    Vec3 tint{1, 0.5f, 0};
    Vec3 offset{0, 1, 2};
    std::string file = "sky.hdr";
    float inner = 3;

    void describe(ParameterVisitor& v) {
        v.number(
            "alpha", alpha,
            {.label = "Alpha", .min = 0.01, .max = 1, .scale = Scale::Log, .help = "Weight of the new value (eq. 1)"});
        v.when(temporal, [&] {
            v.integer(
                "levels", levels,
                {.label = "Levels", .min = 1, .max = 8, .unit = "px", .help = "Iterations", .redo = Redo::History});
            v.when(filter == Filter::Box, [&] {
                v.number("inner", inner, {.label = "Inner", .min = -10, .max = 10, .help = "Only with box"});
            });
        });
        v.toggle("temporal", temporal, {.label = "Temporal", .help = "Accumulate", .redo = Redo::History});
        v.choice("filter", filter, {.label = "Filter", .options = {"box", "gauss", "catmull-rom"}, .help = "Kernel"});
        v.colour("tint", tint, {.label = "Tint", .max = 2, .help = "Colour"});
        v.vector("offset", offset, {.label = "Offset", .help = "Shift"});
        v.text("file", file, {.label = "File", .help = "Environment"});
    }
    Describe describer() {
        return [this](ParameterVisitor& v) { describe(v); };
    }
};

}  // namespace lumi::test
