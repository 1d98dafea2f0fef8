#pragma once

#include <string>

namespace lodestar {

/// Text as one word of a command line, in single quotes whatever it holds.
inline std::string shell_quoted(const std::string& text) {
  std::string word = "'";
  for (const char letter : text) word += letter == '\'' ? std::string("'\\''") : std::string(1, letter);
  return word + "'";
}

}  // namespace lodestar
