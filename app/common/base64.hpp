#pragma once

#include <string>
#include <string_view>

namespace lodestar {

/// Base64 text of the bytes (RFC 4648, with padding).
std::string base64(std::string_view bytes);

}  // namespace lodestar
