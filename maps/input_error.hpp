#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

namespace lodestar {

/// Input that cannot be used. what() reads `file:line: found ..., wanted ...`; line 0 (the error has no line:
/// a missing or binary file) is left out. The command line turns it into exit code 2.
class InputError : public std::runtime_error {
 public:
  InputError(const std::filesystem::path& file, int line, const std::string& found,
             const std::string& wanted);
  explicit InputError(const std::string& message) : std::runtime_error(message) {}
};

}  // namespace lodestar
