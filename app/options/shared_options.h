#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "app/options/option_text.h"

namespace lumi {

/// An option that may stand several times, each with one value.
void addRepeatable(CLI::App& app, const char* name, std::vector<std::string>& values, const char* type,
                   const char* help);
/// --module, --set and the parameters that have an option of their own: addValues() makes document values of them.
void addShared(CLI::App& app, SharedText& text, SceneOptions& scene);
void addCameraPath(CLI::App& app, SceneOptions& scene);
/// --json and --quiet; of a command that computes also --threads, --isa and --memory-limit.
void addMachine(CLI::App& app, MachineOptions& machine, bool computes);

/// Checks of an option's text that refuse in the house's form: "expected one of ..., found ...".
CLI::Validator oneOf(std::vector<std::string> names);
CLI::Validator between(double least, double most);

/// --frames and --warm-up as typed.
struct FramesText {
    std::string frames, warmUp;
    void add(CLI::App& app);
};

/// --progress as typed.
struct ProgressText {
    std::string when = "auto";
    void add(CLI::App& app);
    Progress progress() const;
};

}  // namespace lumi
