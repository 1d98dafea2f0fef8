#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

#include "drivers/can/can_bus.hpp"

// The log format of can-utils' candump, which canplayer replays: `(1700000000.123456) can0 123#1122`.
namespace lodestar {

struct LoggedCanFrame {
  StampedCanFrame received;
  std::string interface;
};

/// One line, without the line end. The stamp is truncated to microseconds; it must not be negative.
std::string candump_line(const StampedCanFrame& frame, const std::string& interface = "can0");

/// Writes a log line by line.
class CandumpWriter {
 public:
  explicit CandumpWriter(std::ostream& out, std::string interface = "can0");
  void write(const StampedCanFrame& frame);

 private:
  std::ostream& out_;
  std::string interface_;
};

/// Reads a log of data frames with 11-bit identifiers, 6 or 9 decimals, with or without a direction (` R`, `
/// T`) at the end. Throws InputError with file and line for anything else, including extended, remote, error
/// and FD frames and DROPCOUNT lines (a log with gaps): what cannot be played back must not be skipped
/// silently.
std::vector<LoggedCanFrame> read_candump(std::istream& in, const std::filesystem::path& file);
std::vector<LoggedCanFrame> load_candump(const std::filesystem::path& file);

}  // namespace lodestar
