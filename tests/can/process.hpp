#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <string>
#include <sys/types.h>
#include <thread>
#include <vector>

#include "drivers/system/file_descriptor.hpp"
#include "maps/stamp.hpp"

namespace lodestar {

/// A line that a program has printed.
struct Line {
  Stamp stamp;  ///< of its arrival
  std::string text;
};

/// A program that runs beside the test; killed by the destructor if still running.
class Process {
 public:
  /// The program's input stays open until it ends.
  explicit Process(std::vector<std::string> words);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void say(const std::string& line);
  void signal(int number) const;
  /// Its exit code, or minus the signal that ended it, once all its output is here; nothing when it does not
  /// end in time.
  std::optional<int> wait(Duration longest);
  /// Ends it by SIGTERM and returns all its output.
  std::string end();

  /// Its output so far, on both streams.
  [[nodiscard]] std::string output() const;
  /// When it first printed a line with these words after `since`; nothing when it has not.
  [[nodiscard]] std::optional<Stamp> said(const std::string& words, Stamp since = Stamp{}) const;

  [[nodiscard]] pid_t id() const { return id_; }

 private:
  void listen(const std::stop_token& stop);
  void await_last_words() const;

  FileDescriptor input_;
  FileDescriptor printed_;
  pid_t id_ = -1;
  std::optional<int> ended_;
  mutable std::mutex mutex_;
  std::vector<Line> lines_;
  std::atomic<Stamp> read_until_{Stamp{}};  ///< all that was printed before is in `lines_`
  std::jthread thread_;
};

/// Runs a shell command; true when its exit code is 0.
bool shell(const std::string& line);

}  // namespace lodestar
