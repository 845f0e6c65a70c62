#pragma once
#include <optional>
#include <set>
#include <string>

#include "params/parameter.h"
#include "ui/app_state.h"

namespace lumi {

// The only place that turns a declaration into widgets.

/// What happened to a parameter's row in this frame.
struct ParameterEdit {
    std::optional<ParameterValue> value;  ///< the new value
    bool reset = false;                   ///< go back to the initial one
    bool finished = false;                ///< the edit ended: one step of undo
};

/// One row: label, widget, mark and reset button if `changed`. The label's tooltip has help, unit and range.
ParameterEdit parameterRow(const ParameterInfo& info, bool changed);

/// Rows of all active parameters whose id begins with `prefix`, applied to the document. With a search text, only those
/// whose label or id holds it; never those of `without`. Returns how many were drawn.
int parameterRows(AppState& state, const std::string& prefix, const std::string& search = "",
                  const std::set<std::string>& without = {});

/// Does a row with these words answer the search? Case does not matter.
bool matches(const std::string& search, const std::string& text);

}  // namespace lumi
