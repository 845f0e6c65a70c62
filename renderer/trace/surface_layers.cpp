#include <cmath>

#include "trace/surface_material.h"

namespace lumi {
namespace {

void readAnisotropy(const Material& m, TextureLookups& lookup, LayerInputs& layers) {
    Vec2 direction(1, 0);
    layers.anisotropy = m.anisotropy;
    if (m.anisotropyTexture) {
        const Vec4 texel = lookup(m.anisotropyTexture);
        direction = Vec2(texel) * 2.0f - Vec2(1);
        layers.anisotropy *= texel.z;
    }
    const float c = std::cos(m.anisotropyRotation), s = std::sin(m.anisotropyRotation);
    layers.anisotropyDirection = {c * direction.x - s * direction.y, s * direction.x + c * direction.y};
}

}  // namespace

void evaluateLayers(const Material& m, TextureLookups& lookup, BsdfInputs& inputs) {
    LayerInputs& layers = inputs.layers;
    inputs.layered = true;
    layers.clearcoat = m.clearcoat, layers.clearcoatRoughness = m.clearcoatRoughness;
    if (m.clearcoat > 0) {
        if (m.clearcoatTexture) layers.clearcoat *= lookup(m.clearcoatTexture).x;
        if (m.clearcoatRoughnessTexture) layers.clearcoatRoughness *= lookup(m.clearcoatRoughnessTexture).y;
    }
    layers.sheenColor = m.sheenColor, layers.sheenRoughness = m.sheenRoughness;
    if (m.hasSheen()) {
        if (m.sheenColorTexture) layers.sheenColor *= Vec3(lookup(m.sheenColorTexture));
        if (m.sheenRoughnessTexture) layers.sheenRoughness *= lookup(m.sheenRoughnessTexture).w;
    }
    if (m.anisotropy > 0) readAnisotropy(m, lookup, layers);
    layers.iridescence = m.iridescence;
    if (m.iridescence > 0) {
        if (m.iridescenceTexture) layers.iridescence *= lookup(m.iridescenceTexture).x;
        const float at = m.iridescenceThicknessTexture ? lookup(m.iridescenceThicknessTexture).y : 1;
        layers.iridescenceIor = m.iridescenceIor;
        layers.iridescenceThickness =
            m.iridescenceThicknessMin + (m.iridescenceThicknessMax - m.iridescenceThicknessMin) * at;
    }
}

}  // namespace lumi
