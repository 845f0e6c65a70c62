#pragma once
#include <nlohmann/json.hpp>
#include <string>

namespace lumi {

/// A JSON value as text, for reports and states. Bytes that are no UTF-8, which names of files may hold, become U+FFFD
/// each.
template <class Json>
std::string jsonText(const Json& value, int indent = -1) {
    return value.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace lumi
