#pragma once
#include <string>
#include <string_view>

namespace lumi {

/// What a message says of names and values that come from files: one line, whatever they hold, and of long ones the
/// first and last parts, `most` bytes in all. Cuts no character of UTF-8.
std::string messageText(std::string_view text, size_t most);

/// Bytes of one part of an error, and of a whole message.
inline constexpr size_t kMostOfErrorPart = 1000, kMostOfMessage = 4000;

}  // namespace lumi
