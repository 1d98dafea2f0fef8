#pragma once

#include <optional>
#include <string>
#include <sys/types.h>
#include <vector>

#include "drivers/file_descriptor.hpp"
#include "maps/stamp.hpp"

namespace lodestar {

/// A program that runs beside the test; killed at the end if it still does.
class Process {
 public:
  /// What it prints, on either stream, goes to the file `log`. Its input stays open until it ends.
  Process(std::vector<std::string> words, std::string log);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void say(const std::string& line);
  void signal(int number) const;
  /// Its exit code, when it ends within that time; minus the signal that ended it.
  std::optional<int> wait(Duration longest);
  /// Ends it politely and returns all that it printed.
  std::string end();
  [[nodiscard]] std::string output() const;
  [[nodiscard]] pid_t id() const { return id_; }

 private:
  std::string log_;
  FileDescriptor input_;
  pid_t id_ = -1;
  std::optional<int> ended_;
};

/// A line for the shell; true when it says that it is done.
bool shell(const std::string& line);

}  // namespace lodestar
