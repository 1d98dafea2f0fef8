#pragma once

#include <filesystem>
#include <string>

namespace lodestar {

/// The exit code and output of a command.
struct Ran {
  int exit_code = -1;
  std::string out;
  std::string err;
};

/// Runs `lodestar` with these arguments (words as the shell splits them) in `folder`.
Ran run_lodestar(const std::string& arguments, const std::filesystem::path& folder);

/// A temporary folder for one test, removed at the end.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Writes a file, and makes the folders above it.
void write_text(const std::filesystem::path& file, const std::string& text);
std::string read_text(const std::filesystem::path& file);

}  // namespace lodestar
