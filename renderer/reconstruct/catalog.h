#pragma once
#include <memory>
#include <span>
#include <string>

#include "reconstruct/module.h"

namespace lumi {

/// One row for each method the program has.
struct ModuleEntry {
    const char* id;
    const char* title;
    const char* paper;  ///< bibliography key of the README, or empty
    std::unique_ptr<Module> (*make)();
};

std::span<const ModuleEntry> moduleCatalog();

/// The entry of an instance name: `svgf` and `svgf@b` are both svgf. Throws Error(Usage) naming the nearest id.
const ModuleEntry& findModule(const std::string& instanceName, const std::string& where = "");

}  // namespace lumi
