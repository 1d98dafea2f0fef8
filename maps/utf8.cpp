#include "maps/utf8.hpp"

#include <algorithm>

namespace lodestar {
namespace {

constexpr auto byte_at = [](std::string_view text, std::size_t i) {
  return static_cast<unsigned char>(text[i]);
};

/// RFC 3629, section 4: the second byte excludes overlong forms, surrogates, and what lies beyond U+10FFFF.
bool is_second_byte(unsigned char lead, unsigned char byte) {
  const unsigned char least = lead == 0xE0U ? 0xA0U : lead == 0xF0U ? 0x90U : 0x80U;
  const unsigned char most = lead == 0xEDU ? 0x9FU : lead == 0xF4U ? 0x8FU : 0xBFU;
  return byte >= least && byte <= most;
}

}  // namespace

std::size_t utf8_character_bytes(std::string_view text) {
  if (text.empty()) return 0;
  const unsigned char lead = byte_at(text, 0);
  if (lead < 0x80U) return 1;
  const std::size_t size = lead >= 0xF0U ? 4 : lead >= 0xE0U ? 3 : 2;
  if (lead < 0xC2U || lead > 0xF4U || text.size() < size || !is_second_byte(lead, byte_at(text, 1))) return 0;
  const auto continues = [](char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U; };
  return std::ranges::all_of(text.substr(2, size - 2), continues) ? size : 0;
}

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t bytes = utf8_character_bytes(text);
    if (bytes == 0) return false;
    text.remove_prefix(bytes);
  }
  return true;
}

}  // namespace lodestar
