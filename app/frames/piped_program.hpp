#pragma once

#include <string>
#include <sys/types.h>
#include <vector>

#include "drivers/system/file_descriptor.hpp"

namespace lodestar {

/// Another program, what it writes read by pipes while it runs. Its standard input is empty, its standard
/// error is dropped.
class PipedProgram {
 public:
  /// Finds the program, the first word, in PATH. Throws std::system_error where it cannot be begun.
  explicit PipedProgram(std::vector<std::string> words);
  /// Ends it, where it has not ended.
  ~PipedProgram();
  PipedProgram(const PipedProgram&) = delete;
  PipedProgram& operator=(const PipedProgram&) = delete;

  /// To read its standard output, and what it writes to its descriptor 3.
  [[nodiscard]] int output() const { return output_.get(); }
  [[nodiscard]] int third() const { return third_.get(); }

 private:
  FileDescriptor output_;
  FileDescriptor third_;
  pid_t pid_ = 0;
};

/// Reads to the end of what is written.
std::string read_to_end(int descriptor);

}  // namespace lodestar
