#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace lodestar {

/// Text in which bytes are written as %41, as in addresses (RFC 3986). Nothing when an escape is malformed or
/// stands for NUL.
std::optional<std::string> percent_decoded(std::string_view text);

}  // namespace lodestar
