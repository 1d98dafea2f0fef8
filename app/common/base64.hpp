#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace lodestar {

/// Base64 text of the bytes (RFC 4648, with padding).
std::string base64(std::string_view bytes);

/// The bytes of such a text; nothing where it is none.
std::optional<std::string> from_base64(std::string_view text);

}  // namespace lodestar
