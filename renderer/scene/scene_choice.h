#pragma once
#include <string>

#include "params/parameter.h"

namespace lumi {

/// Which of several things that a glTF file holds is shown: the parameters scene.index, scene.variant, scene.animation.
struct SceneChoice {
    int index = -1;           ///< of its scenes; -1 is the file's default
    std::string variant{};    ///< of KHR_materials_variants, by name; empty is the default
    std::string animation{};  ///< by name or number; empty: each that moves nothing that an earlier one moves
    bool operator==(const SceneChoice&) const = default;

    void describe(ParameterVisitor& visitor);
    /// Sets the parameter `id` from its text; false if it is none of these. Throws Error(Usage) headed by `where`.
    bool set(const std::string& id, const std::string& text, const std::string& where);
};

}  // namespace lumi
