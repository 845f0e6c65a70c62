#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace lumi {

/// Entries of a map's table: neighbouring ones differ by at most four levels in each byte.
inline constexpr int kColourTableSize = 1024;

/// Colours of a map, evenly over [0, 1], as 0xAABBGGRR. Throws Error(Usage) for an unknown map.
const std::vector<uint32_t>& colourTable(const std::string& map);

/// Well-separated colour of an id as 0xAABBGGRR; 0 is black.
uint32_t idColour(uint32_t id);

/// Polynomial coefficients by channel, lowest power first (colour_map_tables.cpp).
struct ColourPolynomial {
    float coefficients[3][7];
};
extern const ColourPolynomial kViridis, kMagma, kTurbo;

/// Control colours of the diverging map, evenly from -1 to 1, sRGB.
inline constexpr int kSignedStops = 9;
extern const float kSigned[kSignedStops][3];

}  // namespace lumi
