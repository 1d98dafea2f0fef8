#pragma once

#include <string>

#include "maps/input_error.hpp"

#include "tests/maps/temporary_folder.hpp"

// Files that are valid but for one piece, and the error messages for them.
namespace lodestar {

/// A text with one piece of it replaced.
inline std::string with(std::string text, const std::string& piece, const std::string& by) {
  return text.replace(text.find(piece), piece.size(), by);
}

/// The error message of `load` for a file of this name and text.
template <typename Load>
std::string error_of(const std::string& name, const std::string& text, Load load) {
  const TemporaryFolder folder;
  try {
    (void)load(folder.write(name, text));
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace lodestar
