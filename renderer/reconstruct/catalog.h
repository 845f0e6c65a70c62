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
    /// What is amiss with the parameters of one of its instances, or with the frame for it, in a sentence; empty:
    /// nothing. May be null.
    std::string (*advice)(const Module&, const FrameSampling&) = nullptr;
};

std::span<const ModuleEntry> moduleCatalog();

/// Adds a method to the catalogue while it lives: how tests try the frame loop on methods that block, stop or fail.
/// Made and destroyed while no other thread looks into the catalogue.
class CatalogAddition {
public:
    explicit CatalogAddition(const ModuleEntry& entry);
    ~CatalogAddition();
    CatalogAddition(const CatalogAddition&) = delete;
    CatalogAddition& operator=(const CatalogAddition&) = delete;
};

/// The entry of an instance name: `svgf` and `svgf@b` are both svgf. Throws Error(Usage) naming the nearest id.
const ModuleEntry& findModule(const std::string& instanceName, const std::string& where = "");

}  // namespace lumi
