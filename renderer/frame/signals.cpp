#include "frame/signals.h"

#include <cassert>
#include <cstring>

namespace lumi {
namespace {

constexpr const char* kRadiance = "W/(m^2 sr)";

const SignalInfo kInfos[] = {
    {"noisy", "RGB", false, kRadiance, "The frame's radiance as traced"},
    {"emission", "RGB", false, kRadiance, "Light that reaches the camera unscattered: emitters and sky"},
    {"albedo", "RGB", false, "", "Directional albedo of the diffuse lobe"},
    {"specularAlbedo", "RGB", false, "", "Directional albedo of all specular lobes together"},
    {"directDiffuse", "RGB", false, kRadiance, "Direct light on the diffuse lobe, divided by albedo"},
    {"indirectDiffuse", "RGB", false, kRadiance, "Indirect light on the diffuse lobe, divided by albedo"},
    {"directSpecular", "RGB", false, kRadiance, "Direct light on the specular lobes, divided by specularAlbedo"},
    {"indirectSpecular", "RGB", false, kRadiance, "Indirect light on the specular lobes, divided by specularAlbedo"},
    {"direct", "RGB", false, kRadiance, "Direct light, both lobes, remodulated"},
    {"indirect", "RGB", false, kRadiance, "Indirect light, both lobes, remodulated"},
    {"visibility", "Y", false, "", "Fraction of the light samples at the first surface that were not blocked"},
    {"sampleVariance", "RGB", false, "", "Variance of one sample's radiance over the frame's samples"},
    {"normal", "XYZ", false, "", "Shading normal, world space"},
    {"geometricNormal", "XYZ", false, "", "Triangle normal, world space"},
    {"objectNormal", "XYZ", false, "", "Shading normal, object space in the rest pose"},
    {"depth", "Z", false, "m", "Linear view depth; +inf on the sky"},
    {"inverseDepth", "Z", false, "1/m", "Reciprocal of depth; affine on a plane"},
    {"depthGradient", "XY", false, "1/(m px)", "Screen derivatives of the reciprocal depth"},
    {"position", "XYZ", false, "m", "World position"},
    {"motion", "XYZ", false, "px", "Previous minus current pixel (X, Y) and view depth (Z)"},
    {"roughness", "Y", false, "", "Roughness of the first surface"},
    {"objectId", "I", true, "", "1 + instance; 0 on the sky"},
    {"materialId", "I", true, "", "1 + material; 0 on the sky"},
    {"surface", "IPUV", true, "", "Instance, primitive and barycentrics of the first hit"},
};
static_assert(std::size(kInfos) == kSignalCount);

}  // namespace

const SignalInfo& signalInfo(Signal signal) {
    assert(signal < Signal::Count);
    return kInfos[static_cast<size_t>(signal)];
}

Signal signalByName(std::string_view name) {
    for (int i = 0; i < kSignalCount; ++i)
        if (name == kInfos[i].name) return static_cast<Signal>(i);
    return Signal::Count;
}

void Signals::reset(Extent2 extent, const SignalSet& wanted, int samplesPerPixel) {
    const bool sameExtent = extent == extent_;
    extent_ = extent;
    available_ = wanted;
    samplesPerPixel_ = samplesPerPixel;
    for (int i = 0; i < kSignalCount; ++i) {
        const auto index = static_cast<size_t>(i);
        const bool keep = wanted.has(static_cast<Signal>(i));
        const int channels = static_cast<int>(std::strlen(kInfos[i].channels));
        if (!keep) {
            floats_[index] = {};
            ids_[index] = {};
        } else if (kInfos[i].isId) {
            if (!sameExtent || ids_[index].empty()) ids_[index].reset(extent, channels);
        } else if (!sameExtent || floats_[index].empty()) {
            floats_[index].reset(extent, channels);
        }
    }
    if (!wanted.has(Signal::Noisy)) noisySum_ = {};
    else if (!sameExtent || noisySum_.empty()) noisySum_.reset(extent, 3);
}

size_t Signals::bytes() const {
    size_t total = noisySum_.bytes();
    for (const Image& image : floats_) total += image.bytes();
    for (const IdImage& image : ids_) total += image.bytes();
    return total;
}

}  // namespace lumi
