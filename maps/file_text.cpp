#include "maps/file_text.hpp"

#include <fstream>
#include <sstream>
#include <utility>

#include "maps/input_error.hpp"
#include "maps/path_kind.hpp"

namespace lodestar {

std::optional<std::string> file_text(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream || is_folder(file)) return std::nullopt;
  std::ostringstream text;  // of some files the size is not known before: /proc
  text << stream.rdbuf();
  return text.str();
}

std::string file_text(const std::filesystem::path& file, const std::string& wanted) {
  if (std::optional<std::string> text = file_text(file)) return *std::move(text);
  throw InputError(file, 0, is_folder(file) ? "a folder" : "no file that can be read", wanted);
}

}  // namespace lodestar
