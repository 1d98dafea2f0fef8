#include "app/common/json_parse.hpp"

#include <fmt/format.h>

#include "maps/input_error.hpp"

namespace lodestar {
namespace {

constexpr int most_levels = 32;

/// Brackets in strings do not count.
bool is_nested_too_deep(std::string_view text) {
  int level = 0;
  bool is_in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (is_in_string && c == '\\') {
      ++i;
    } else if (c == '"') {
      is_in_string = !is_in_string;
    } else if (!is_in_string && (c == '[' || c == '{')) {
      if (++level > most_levels) return true;
    } else if (!is_in_string && (c == ']' || c == '}')) {
      --level;
    }
  }
  return false;
}

}  // namespace

nlohmann::json parse_json(std::string_view text) {
  if (is_nested_too_deep(text)) {
    throw InputError(
        fmt::format("found JSON nested deeper than {0} levels, wanted {0} at most", most_levels));
  }
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::exception& error) {
    throw InputError(fmt::format("found no JSON ({}), wanted it", error.what()));
  }
}

}  // namespace lodestar
