#pragma once

#include <string_view>

namespace lodestar {

/// Bytes of the character that a text begins with, in UTF-8 (RFC 3629); 0 where it begins with none.
std::size_t utf8_character_bytes(std::string_view text);

/// Is all of the text UTF-8?
bool is_utf8(std::string_view text);

}  // namespace lodestar
