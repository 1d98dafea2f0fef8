#pragma once

#include <mutex>
#include <optional>
#include <string>
#include <sys/types.h>
#include <thread>
#include <vector>

#include "drivers/system/file_descriptor.hpp"
#include "maps/stamp.hpp"

namespace lodestar {

/// What a program has printed.
struct Line {
  Stamp stamp;  ///< of its arrival
  std::string text;
};

/// A program that runs beside the test; killed at the end if it still does.
class Process {
 public:
  /// Its input stays open until it ends.
  explicit Process(std::vector<std::string> words);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void say(const std::string& line);
  void signal(int number) const;
  /// Its exit code, when it ends within that time; minus the signal that ended it.
  std::optional<int> wait(Duration longest);
  /// Ends it politely and returns all that it printed.
  std::string end();

  /// What it has printed so far, on either stream.
  [[nodiscard]] std::string output() const;
  /// When it first printed a line with these words after `since`; nothing when it has not.
  [[nodiscard]] std::optional<Stamp> said(const std::string& words, Stamp since = Stamp{}) const;

  [[nodiscard]] pid_t id() const { return id_; }

 private:
  void listen(const std::stop_token& stop);

  FileDescriptor input_;
  FileDescriptor printed_;
  pid_t id_ = -1;
  std::optional<int> ended_;
  mutable std::mutex mutex_;
  std::vector<Line> lines_;
  std::jthread thread_;
};

/// A line for the shell; true when it says that it is done.
bool shell(const std::string& line);

}  // namespace lodestar
