#pragma once

#include <filesystem>

namespace lodestar {

// What a path of unknown origin leads to. std::filesystem's own questions throw where it cannot even be
// asked, as when a name is too long; then there is nothing here.

inline bool is_folder(const std::filesystem::path& path) {
  std::error_code cannot;
  return std::filesystem::is_directory(path, cannot);
}

inline bool is_file(const std::filesystem::path& path) {
  std::error_code cannot;
  return std::filesystem::is_regular_file(path, cannot);
}

}  // namespace lodestar
