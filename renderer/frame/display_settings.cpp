#include <algorithm>
#include <string_view>

#include "frame/display.h"

namespace lumi {
namespace {

std::vector<const char*> mapOptions() {
    std::vector<const char*> options = {"auto", "none"};
    options.insert(options.end(), colourMapNames().begin(), colourMapNames().end());
    return options;
}

}  // namespace

void DisplaySettings::describe(ParameterVisitor& v) {
    v.number("exposure", exposureEv,
             {.label = "Exposure",
              .min = -16,
              .max = 16,
              .unit = "EV",
              .help = "Stops by which linear colours are brightened before the tone curve",
              .redo = Redo::Display});
    v.choice("tone-curve", curve,
             {.label = "Tone curve",
              .options = {"clamp", "reinhard", "aces", "agx"},
              .help = "How linear colours are brought into [0, 1]: cut off, Reinhard 2002 (eq. 3), ACES (Hill's fit), "
                      "AgX (Sobotka; Wrensch's fit)",
              .redo = Redo::Display});

    const std::vector<const char*> maps = mapOptions();
    const auto present = std::find_if(maps.begin(), maps.end(), [&](const char* map) { return colourMap == map; });
    int index = present == maps.end() ? 0 : static_cast<int>(present - maps.begin());
    v.choiceIndex("colour-map", index,
                  {.label = "Colour map",
                   .options = maps,
                   .help = "False colours; auto takes the buffer's own, none shows colours as they are",
                   .redo = Redo::Display});
    colourMap = maps[static_cast<size_t>(index)];

    v.toggle(
        "auto-range", autoRange,
        {.label = "Automatic range",
         .help =
             "The map spans the buffer's own range where it has one (codes, weights, counts), else the 1st to the 99th "
             "percentile of the finite values",
         .redo = Redo::Display});
    v.when(!autoRange, [&] {
        v.number(
            "low", low,
            {.label = "Low", .min = -1e6, .max = 1e6, .help = "Value at the map's lower end", .redo = Redo::Display});
        v.number(
            "high", high,
            {.label = "High", .min = -1e6, .max = 1e6, .help = "Value at the map's upper end", .redo = Redo::Display});
    });
    int shown = channel + 1;
    v.choiceIndex("channel", shown,
                  {.label = "Channel",
                   .options = {"all", "1", "2", "3", "4"},
                   .help = "All channels of the buffer, or one of them: 1 is R, X or Y, 2 is G or Y, and so on",
                   .redo = Redo::Display});
    channel = shown - 1;
}

}  // namespace lumi
