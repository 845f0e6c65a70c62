#include "frame/colour_maps.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "frame/display.h"
#include "math/hash.h"

namespace lumi {
namespace {

Vec3 evaluate(const ColourPolynomial& polynomial, float t) {
    Vec3 colour;
    for (int c = 0; c < 3; ++c) {
        float value = 0;
        for (int power = 6; power >= 0; --power) value = value * t + polynomial.coefficients[c][power];
        colour[c] = value;
    }
    return glm::clamp(colour, Vec3(0), Vec3(1));
}

Vec3 diverging(float t) {
    const float place = t * (kSignedStops - 1);
    const int stop = std::min(static_cast<int>(place), kSignedStops - 2);
    const auto& a = kSigned[stop];
    const auto& b = kSigned[stop + 1];
    return glm::mix(Vec3(a[0], a[1], a[2]), Vec3(b[0], b[1], b[2]), place - static_cast<float>(stop));
}

/// Three squared cosines a third of a period apart: constant sum, no seam. Also the wheel's rim.
Vec3 cyclic(float t) {
    Vec3 colour;
    for (int c = 0; c < 3; ++c) colour[c] = sqr(std::cos(kPi * (t - static_cast<float>(c) / 3.0f)));
    return colour;
}

/// Hues step by the golden ratio, which keeps any run of them apart; brightness and saturation vary beside.
Vec3 colourOfId(uint32_t id) {
    if (id == 0) return Vec3(0);
    const double turn = id * 0.6180339887498949;
    const float hue = static_cast<float>(turn - std::floor(turn)) * 6;
    const uint32_t bits = pcgHash(id);
    const float value = 0.65f + 0.35f * unitFloat(bits), saturation = 0.5f + 0.4f * unitFloat(pcgHash(bits));
    Vec3 colour;
    const float offsets[] = {0, 4, 2};
    for (int c = 0; c < 3; ++c) {
        const float place = std::fmod(hue + offsets[c], 6.0f);
        const float pure = std::clamp(std::abs(place - 3) - 1, 0.0f, 1.0f);
        colour[c] = value * (1 - saturation * (1 - pure));
    }
    return colour;
}

uint32_t bytesOf(const Vec3& colour) {
    uint32_t result = 0xff000000u;
    for (int c = 0; c < 3; ++c)
        result |= static_cast<uint32_t>(std::clamp(colour[c], 0.0f, 1.0f) * 255 + 0.5f) << (8 * c);
    return result;
}

std::map<std::string, std::vector<uint32_t>> makeTables() {
    std::map<std::string, std::vector<uint32_t>> tables;
    for (const std::string name : colourMapNames())
        for (int i = 0; i < kColourTableSize; ++i)
            tables[name].push_back(bytesOf(colourMapValue(name, static_cast<float>(i) / (kColourTableSize - 1))));
    return tables;
}

std::string allNames() {
    std::string list;
    for (const char* name : colourMapNames()) list += (list.empty() ? "" : ", ") + std::string(name);
    return list;
}

}  // namespace

const std::vector<const char*>& colourMapNames() {
    static const std::vector<const char*> names = {"viridis", "turbo", "magma", "gray",  "signed",
                                                   "cyclic",  "ids",   "wheel", "motion"};
    return names;
}

Vec3 colourMapValue(const std::string& map, float t) {
    t = t > 0 ? std::min(t, 1.0f) : 0.0f;
    if (map == "viridis") return evaluate(kViridis, t);
    if (map == "magma") return evaluate(kMagma, t);
    if (map == "turbo") return evaluate(kTurbo, t);
    if (map == "gray") return Vec3(t);
    if (map == "signed") return diverging(t);
    if (map == "cyclic" || isWheel(map)) return cyclic(t);
    if (map == "ids") return colourOfId(static_cast<uint32_t>(t * 255));
    throwUsage({"unknown colour map", "", allNames(), '"' + map + '"'});
}

const std::vector<uint32_t>& colourTable(const std::string& map) {
    static const std::map<std::string, std::vector<uint32_t>> tables = makeTables();
    const auto table = tables.find(map);
    if (table == tables.end()) throwUsage({"unknown colour map", "", allNames(), '"' + map + '"'});
    return table->second;
}

uint32_t idColour(uint32_t id) {
    static const std::vector<uint32_t> colours = [] {
        std::vector<uint32_t> list;
        for (uint32_t i = 1; i <= 4093; ++i) list.push_back(bytesOf(colourOfId(i)));
        return list;
    }();
    return id == 0 ? 0xff000000u : colours[(id - 1) % colours.size()];
}

}  // namespace lumi
