#pragma once
#include "params/parameter.h"

namespace lumi {

/// Passes an object's declarations on under other ids: `roughness` as `material.floor.roughness`.
class RenamingVisitor : public ParameterVisitor {
public:
    /// The id that stands for an object's own; empty: the parameter is left out.
    using Rename = std::function<std::string(const std::string&)>;
    RenamingVisitor(ParameterVisitor& inner, Rename rename) : inner_(inner), rename_(std::move(rename)) {}
    RenamingVisitor(ParameterVisitor& inner, const std::string& prefix)
        : RenamingVisitor(inner, [prefix](const std::string& id) { return prefix + id; }) {}

    void number(const char* id, float& value, const NumberSpec& spec) override {
        pass(id, [&](const char* name) { inner_.number(name, value, spec); });
    }
    void integer(const char* id, int& value, const NumberSpec& spec) override {
        pass(id, [&](const char* name) { inner_.integer(name, value, spec); });
    }
    void toggle(const char* id, bool& value, const SwitchSpec& spec) override {
        pass(id, [&](const char* name) { inner_.toggle(name, value, spec); });
    }
    void choiceIndex(const char* id, int& value, const ChoiceSpec& spec) override {
        pass(id, [&](const char* name) { inner_.choiceIndex(name, value, spec); });
    }
    void colour(const char* id, Vec3& value, const ColourSpec& spec) override {
        pass(id, [&](const char* name) { inner_.colour(name, value, spec); });
    }
    void vector(const char* id, Vec3& value, const VectorSpec& spec) override {
        pass(id, [&](const char* name) { inner_.vector(name, value, spec); });
    }
    void text(const char* id, std::string& value, const TextSpec& spec) override {
        pass(id, [&](const char* name) { inner_.text(name, value, spec); });
    }

private:
    void pass(const char* id, const std::function<void(const char*)>& declare) {
        const std::string name = rename_(id);
        if (!name.empty()) inner_.when(active(), [&] { declare(name.c_str()); });
    }
    ParameterVisitor& inner_;
    Rename rename_;
};

}  // namespace lumi
