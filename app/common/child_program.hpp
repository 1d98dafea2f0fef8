#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace lodestar {

/// How another program ended.
struct ProgramEnd {
  std::optional<int> exit_code;  ///< nothing: it did not begin, or a signal ended it
  std::string why;               ///< in words, where there is no exit code
  std::string output;
  std::string last_words;  ///< the last line of its standard error
  double wall_s = 0.0;
};

/// Runs a program to its end. What it writes goes into the two files, and is read from there.
ProgramEnd run_program_to_end(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                              const std::filesystem::path& output_file,
                              const std::filesystem::path& error_file);

}  // namespace lodestar
