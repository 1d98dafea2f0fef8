#pragma once

#include <string>
#include <string_view>

namespace lodestar {

/// Bytes in letters that any text may hold (RFC 4648, with padding).
std::string base64(std::string_view bytes);

}  // namespace lodestar
