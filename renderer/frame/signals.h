#pragma once
#include <array>
#include <bitset>
#include <cstdint>
#include <initializer_list>
#include <string_view>

#include "image/image.h"

namespace lumi {

/// THE contract between tracing and reconstruction: what one noisy frame is made of.
///
/// Space and units: linear Rec.709 radiance (W/(m^2 sr)); world space is right-handed, +Y up, metres; pixels have their
/// origin top-left. Colours are means over the frame's samples. Geometry (normal, depth, position, motion, ids,
/// surface) is that of the pixel's first sample, at the first surface the camera ray meets, mirrors and glass included:
/// features never pass through specular surfaces.
///
///     noisy = emission + albedo * (directDiffuse + indirectDiffuse)
///                      + specularAlbedo * (directSpecular + indirectSpecular)
///
/// holds in every pixel up to rounding. The four are demodulated illumination. Where a channel of albedo (or of
/// specularAlbedo) would be below 0.01, that term is stored undivided with albedo 1 in that channel; no other albedo of
/// a surface is 1. "Specular" is every lobe but the diffuse one, transmission included. "Direct" is light that meets
/// one surface between emitter and camera; "indirect" is all else. Emission is light that reaches the camera
/// unscattered: emitters and the sky seen directly.
enum class Signal : uint8_t {
    Noisy,             ///< RGB, the frame's radiance
    Emission,          ///< RGB
    Albedo,            ///< RGB in [0,1], directional albedo of the diffuse lobe; 1 on the sky
    SpecularAlbedo,    ///< RGB in [0,1], directional albedo of all specular lobes together; 1 on the sky
    DirectDiffuse,     ///< RGB, demodulated
    IndirectDiffuse,   ///< RGB, demodulated
    DirectSpecular,    ///< RGB, demodulated
    IndirectSpecular,  ///< RGB, demodulated
    Direct,            ///< RGB, remodulated: albedo * directDiffuse + specularAlbedo * directSpecular
    Indirect,          ///< RGB, remodulated
    Visibility,        ///< Y in [0,1], fraction of the light samples at the first surface that were not blocked
    SampleVariance,    ///< RGB, unbiased variance of one sample's radiance over the frame's samples; 0 at 1 spp
    Normal,            ///< XYZ world, unit, shading normal facing the camera; 0 on the sky
    GeometricNormal,   ///< XYZ world, unit, of the triangle, facing the camera; 0 on the sky
    ObjectNormal,      ///< XYZ object space (rest pose for deforming meshes), unit; 0 on the sky
    Depth,             ///< Z, linear view depth in metres; +inf on the sky
    InverseDepth,      ///< Z, 1/depth; 0 on the sky
    DepthGradient,     ///< XY, screen derivatives per pixel of 1/depth on the surface's tangent plane; 0 on the sky
    Position,          ///< XYZ world; 0 on the sky
    /// XYZ: previous pixel minus current pixel (X, Y), view depth (Z); far off the image where the point was behind
    Motion,
    Roughness,   ///< Y in [0,1], the user's roughness; 1 on the sky
    ObjectId,    ///< UINT: 1 + instance index; 0 on the sky
    MaterialId,  ///< UINT: 1 + material index; 0 on the sky
    Surface,     ///< UINT x4: instance, primitive, bits of barycentric u, bits of barycentric v
    Count
};
constexpr int kSignalCount = static_cast<int>(Signal::Count);

struct SignalInfo {
    const char* name;      ///< camelCase, as in files and views
    const char* channels;  ///< one letter each: "RGB", "XYZ", "XY", "Y", "Z", "IPUV"
    bool isId;             ///< stored as uint32
    const char* unit;      ///< "W/(m^2 sr)", "m", "px", ""
    const char* help;
};
const SignalInfo& signalInfo(Signal signal);
/// The signal of that name, or Signal::Count.
Signal signalByName(std::string_view name);

/// A set of signals; what a module reads() and what the tracer is asked to write.
class SignalSet {
public:
    SignalSet() = default;
    SignalSet(std::initializer_list<Signal> signals) {
        for (Signal s : signals) add(s);
    }
    static SignalSet all() {
        SignalSet set;
        set.bits_.set();
        return set;
    }
    void add(Signal s) { bits_.set(static_cast<size_t>(s)); }
    bool has(Signal s) const { return bits_.test(static_cast<size_t>(s)); }
    bool hasAny(const SignalSet& other) const { return (bits_ & other.bits_).any(); }
    bool contains(const SignalSet& other) const { return (bits_ & other.bits_) == other.bits_; }
    SignalSet operator|(const SignalSet& other) const {
        SignalSet set;
        set.bits_ = bits_ | other.bits_;
        return set;
    }
    SignalSet& operator|=(const SignalSet& other) { return *this = *this | other; }
    bool empty() const { return bits_.none(); }
    bool operator==(const SignalSet&) const = default;

private:
    std::bitset<kSignalCount> bits_;
};

/// One noisy frame. A signal that nobody asked for is an empty image.
class Signals {
public:
    /// Takes the extent and allocates `wanted`; kept signals keep their memory. Contents are undefined.
    void reset(Extent2 extent, const SignalSet& wanted, int samplesPerPixel);

    Extent2 extent() const { return extent_; }
    const SignalSet& available() const { return available_; }
    int samplesPerPixel() const { return samplesPerPixel_; }

    const Image& operator[](Signal s) const { return floats_[static_cast<size_t>(s)]; }
    Image& operator[](Signal s) { return floats_[static_cast<size_t>(s)]; }
    const IdImage& ids(Signal s) const { return ids_[static_cast<size_t>(s)]; }
    IdImage& ids(Signal s) { return ids_[static_cast<size_t>(s)]; }

    /// Sum over the frame's samples of their radiance, RGB, in double over aligned power-of-two blocks: what
    /// progressive means add up so that any split of the samples gives the same bits. Present whenever Noisy is.
    const ImageOf<double>& noisySum() const { return noisySum_; }
    ImageOf<double>& noisySum() { return noisySum_; }

    size_t bytes() const;

private:
    Extent2 extent_;
    SignalSet available_;
    int samplesPerPixel_ = 0;
    std::array<Image, kSignalCount> floats_;
    std::array<IdImage, kSignalCount> ids_;
    ImageOf<double> noisySum_;
};

}  // namespace lumi
