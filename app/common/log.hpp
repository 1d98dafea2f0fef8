#pragma once

#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

// What programs say while they run. Results go to standard output, errors that end a program and words at its
// end to standard error as they are.
namespace lodestar {

enum class Severity { debug, info, warning, error };

std::optional<Severity> severity_named(std::string_view name);

struct LogOptions {
  Severity least = Severity::info;
  /// Lines are prefixed with syslog's level, as <4>, and have no time: the journal has its own.
  bool to_journal = false;
  std::FILE* out = stderr;
  std::size_t most_waiting =
      1000;  ///< lines, for a terminal or a pipe that takes nothing; the rest is dropped
};

/// Lines with time (UTC) and severity, written on the side: a terminal that is held or a pipe that nobody
/// reads stops no wheels' command. May be used from any thread.
class Log {
 public:
  explicit Log(const LogOptions& options);
  /// Writes what is left, and how many lines were dropped.
  ~Log();
  Log(const Log&) = delete;
  Log& operator=(const Log&) = delete;

  /// One line, whatever the words hold: control characters become spaces.
  void say(Severity severity, std::string words);
  void set_least(Severity severity);

 private:
  struct Writer;
  std::unique_ptr<Writer> writer_;
};

/// Is what is written to the descriptor read by systemd's journal? `journal_stream`: the environment's
/// JOURNAL_STREAM, the device and inode of the stream that systemd gave to the program; may be null.
bool goes_to_journal(int descriptor, const char* journal_stream);

/// The program's own, on standard error.
Log& program_log();

void log_debug(std::string words);
void log_info(std::string words);
void log_warning(std::string words);

}  // namespace lodestar
