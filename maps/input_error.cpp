#include "maps/input_error.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <string_view>

#include "maps/utf8.hpp"

namespace lodestar {
namespace {

/// Bytes of the character that begins there; 0 where it is no UTF-8, or a control character, which a terminal
/// would obey.
std::size_t character_bytes(std::string_view text) {
  const auto lead = static_cast<unsigned char>(text.front());
  return lead < 0x20U || lead == 0x7FU ? 0 : utf8_character_bytes(text);
}

/// What was found, for people: a whole file that is read as one word, or binary data, would fill the
/// terminal.
std::string shown(std::string_view found) {
  constexpr std::size_t most_bytes = 160;
  std::string text;
  while (!found.empty() && text.size() < most_bytes) {
    const std::size_t size = character_bytes(found);
    text += size > 0 ? std::string(found.substr(0, size))
                     : fmt::format("\\x{:02x}", static_cast<unsigned char>(found.front()));
    found.remove_prefix(std::max<std::size_t>(size, 1));
  }
  return found.empty() ? text : text + "...";
}

std::string message(const std::filesystem::path& file, int line, const std::string& found,
                    const std::string& wanted) {
  const std::string place = line > 0 ? fmt::format("{}:{}", file.string(), line) : file.string();
  return fmt::format("{}: found {}, wanted {}", place, shown(found), wanted);
}

}  // namespace

InputError::InputError(const std::filesystem::path& file, int line, const std::string& found,
                       const std::string& wanted)
    : std::runtime_error(message(file, line, found, wanted)) {}

}  // namespace lodestar
