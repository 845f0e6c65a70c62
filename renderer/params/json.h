#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "params/parameter.h"

namespace lumi {

/// Parameter values as JSON: numbers, booleans, strings, arrays of three.
nlohmann::json toJson(const ParameterValue& value);

/// Reads a value for `info`'s type. Throws Error(Usage) if the JSON has another type; range is setParameter()'s job.
ParameterValue parameterFromJson(const ParameterInfo& info, const nlohmann::json& json, const std::string& where = "");

/// What a tool needs to know of a parameter (`list parameters --json`): id, label, type, unit, range, scale, options,
/// default, help, redo.
nlohmann::json toJson(const ParameterInfo& info);

}  // namespace lumi
