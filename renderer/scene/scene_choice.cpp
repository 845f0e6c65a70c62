#include "scene/scene_choice.h"

namespace lumi {

void SceneChoice::describe(ParameterVisitor& visitor) {
    visitor.integer("scene.index", index,
                    {.label = "Scene",
                     .min = -1,
                     .max = 9999,
                     .help = "Which scene of a glTF file is loaded; -1 is the file's default",
                     .redo = Redo::Build});
    visitor.text("scene.variant", variant,
                 {.label = "Variant", .help = "Material variant by name; empty is the file's default"});
    visitor.text("scene.animation", animation,
                 {.label = "Animation",
                  .help = "Which of a glTF file's animations plays, by name or number; empty plays each that moves "
                          "nothing that an earlier one moves"});
}

bool SceneChoice::set(const std::string& id, const std::string& text, const std::string& where) {
    const auto parameters = [this](ParameterVisitor& visitor) { describe(visitor); };
    for (const ParameterInfo& info : listParameters(parameters)) {
        if (info.id != id) continue;
        setParameter(parameters, id, parseParameter(info, text, where), where);
        return true;
    }
    return false;
}

}  // namespace lumi
