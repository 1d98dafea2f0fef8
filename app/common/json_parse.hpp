#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

namespace lodestar {

/// JSON from outside. Throws InputError for text that is none, and for arrays and objects nested deeper than
/// 32: to print or compare a value recurses on it, and 400 KB of brackets are enough for any stack. Our own
/// messages and the formats that are imported nest six deep (GeoJSON).
nlohmann::json parse_json(std::string_view text);

}  // namespace lodestar
