#include "maps/input_error.hpp"

#include <fmt/format.h>

namespace lodestar {
namespace {

std::string message(const std::filesystem::path& file, int line, const std::string& found,
                    const std::string& wanted) {
  const std::string place = line > 0 ? fmt::format("{}:{}", file.string(), line) : file.string();
  return fmt::format("{}: found {}, wanted {}", place, found, wanted);
}

}  // namespace

InputError::InputError(const std::filesystem::path& file, int line, const std::string& found,
                       const std::string& wanted)
    : std::runtime_error(message(file, line, found, wanted)) {}

}  // namespace lodestar
