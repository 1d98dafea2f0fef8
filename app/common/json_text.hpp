#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace lodestar {

// JSON as we send and write it, in UTF-8. Names of files may hold bytes that are none: they are replaced, as
// a result is worth more than a letter of a path.

/// In one line. `Json` is nlohmann's json or ordered_json.
template <typename Json>
std::string json_text(const Json& content) {
  return content.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// Indented by two, with a newline at the end: for files, and for people.
template <typename Json>
std::string json_document(const Json& content) {
  return content.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace lodestar
