#include "scene/procedural/generators.h"

namespace lumi {

MaterialSlot opaqueSlot(const char* name, const Vec3& baseColor, float roughness, float metallic) {
    MaterialSlot slot;
    slot.name = slot.fallback.name = name;
    slot.fallback.baseColor = baseColor;
    slot.fallback.roughness = roughness;
    slot.fallback.metallic = metallic;
    return slot;
}

MaterialSlot glassSlot(const char* name, const Vec3& attenuationColor, float attenuationDistance, float ior) {
    MaterialSlot slot = opaqueSlot(name, Vec3(1), 0);
    slot.fallback.transmission = 1;
    slot.fallback.thickness = 1;
    slot.fallback.ior = ior;
    slot.fallback.attenuationColor = attenuationColor;
    slot.fallback.attenuationDistance = attenuationDistance;
    return slot;
}

ProceduralResult onePart(Mesh mesh, std::vector<MaterialSlot> slots) {
    ProceduralResult result;
    result.slots = std::move(slots);
    addPart(result, "", std::move(mesh));
    return result;
}

void addPart(ProceduralResult& result, const char* name, Mesh mesh) {
    tidy(mesh);
    ProceduralPart part;
    part.name = name;
    part.mesh = std::make_shared<const Mesh>(std::move(mesh));
    result.parts.push_back(std::move(part));
}

void describeSeed(ParameterVisitor& v, int& seed) {
    v.integer("seed", seed,
              {.label = "Seed", .min = 0, .max = 1e6, .help = "Which of the random arrangements", .redo = Redo::Build});
}

void describeLength(ParameterVisitor& v, const char* id, float& value, const char* label, double min, double max,
                    const char* help) {
    v.number(id, value, {.label = label, .min = min, .max = max, .unit = "m", .help = help, .redo = Redo::Build});
}

void describeCount(ParameterVisitor& v, const char* id, int& value, const char* label, int min, int max,
                   const char* help) {
    v.integer(id, value,
              {.label = label,
               .min = static_cast<double>(min),
               .max = static_cast<double>(max),
               .help = help,
               .redo = Redo::Build});
}

}  // namespace lumi
