#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/scanner/bytes.hpp"

// Hokuyo's SCIP 2.0: lines of text. An answer is the command's echo, a status, lines of at most 64 characters
// of data, and an empty line; each line but the echo ends with a checksum character. Numbers are written in
// characters of 6 bits, 0x30 the zero, the highest first.
namespace lodestar::scip {

inline constexpr std::size_t range_digits = 3;
inline constexpr std::size_t time_digits = 4;  ///< ms, wraps at 2^24

char checksum(std::string_view line);

std::string encode_number(std::uint32_t value, std::size_t digits);
/// Nothing when a character is none of the code.
std::optional<std::uint32_t> decode_number(std::string_view digits);

struct Answer {
  std::string command;             ///< the echo
  std::string status;              ///< two characters
  std::vector<std::string> lines;  ///< without checksums
};

std::string encode(const Answer& answer);
/// An answer whose data is one long text, in lines of 64 characters.
std::string encode_block(const std::string& command, const std::string& status, std::string_view data);
/// Of the text up to the empty line. Nothing when a checksum is wrong.
std::optional<Answer> decode(std::string_view text);
/// The data of encode_block(). Nothing when the lines are not of 64 characters, but for the last.
std::optional<std::string> block_of(const Answer& answer);

/// Product information, as PP gives it.
struct Parameters {
  std::string model;
  int min_range_mm = 0;
  int max_range_mm = 0;
  int steps_per_turn = 0;
  int first_step = 0;
  int last_step = 0;
  int front_step = 0;
  int turns_per_minute = 0;
};
std::vector<std::string> lines_of(const Parameters& parameters);
/// Nothing when a value is missing or impossible.
std::optional<Parameters> parameters_of(const std::vector<std::string>& lines);

/// The order for ranges of 3 characters of all steps, scan after scan without end.
std::string order_to_scan(const Parameters& parameters);

}  // namespace lodestar::scip
