#pragma once
#include <array>
#include <string>
#include <vector>

#include "app/cli.h"

namespace lumi {

/// What the user typed for the options that are shared by several commands.
struct SharedText {
    std::vector<std::string> set;
    std::string size, camera, exposure, fps, spp, seed;
};

/// WIDTHxHEIGHT. All of these throw Error(Usage) headed by the option's name.
Extent2 parseSize(const std::string& text, const std::string& option);
/// N (frames 0..N-1) or A..B.
FrameRange parseFrames(const std::string& text);
/// A number of frames, none of an empty text, all of which come after frame 0.
int64_t parseWarmUp(const std::string& text, const FrameRange& frames);
/// A whole number that is at least `least`.
int64_t parseWhole(const std::string& text, const std::string& option, const char* expected, int64_t least);
/// A..B, half-open, both multiples of 16.
std::pair<uint64_t, uint64_t> parseSamples(const std::string& text, const std::string& option);
/// START,STOP or START,STOP,COUNT.
FlipExposures parseFlipExposures(const std::string& text, const std::string& option);
/// X,Y,W,H in pixels, with a width and a height.
std::array<int, 4> parseCrop(const std::string& text, const std::string& option);
/// The parts between commas, without the blanks around them; none of an empty text.
std::vector<std::string> splitList(const std::string& text);
/// Options that are parameters become values, in the order in which they take effect: those with a name of their own
/// first, then --set as typed.
void addValues(const SharedText& text, SceneOptions& scene);

}  // namespace lumi
