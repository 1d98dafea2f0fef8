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
  if (is_folder(file)) throw InputError(file, 0, "a folder", wanted);
  std::optional<std::string> text = file_text(file);
  if (!text) throw InputError(file, 0, "no file that can be read", wanted);
  return *std::move(text);
}

}  // namespace lodestar
