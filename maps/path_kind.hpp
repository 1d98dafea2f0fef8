#pragma once

#include <filesystem>

namespace lodestar {

// Queries on a path from user input. Those of std::filesystem throw when the path cannot be looked up at all,
// for example when a name is too long; these then answer that nothing is there.

inline bool is_folder(const std::filesystem::path& path) {
  std::error_code cannot;
  return std::filesystem::is_directory(path, cannot);
}

inline bool is_file(const std::filesystem::path& path) {
  std::error_code cannot;
  return std::filesystem::is_regular_file(path, cannot);
}

}  // namespace lodestar
