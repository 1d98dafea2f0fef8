#include "drivers/scanner/scip_wire.hpp"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>

namespace lodestar::scip {
namespace {

constexpr char zero = 0x30;
constexpr std::size_t line_length = 64;
constexpr int most_steps = 1 << 15;

bool is_digit(char character) {
  return character >= zero && character < zero + 64;
}

/// The value of a line `KEY:value;`.
std::optional<std::string_view> value_of(const std::vector<std::string>& lines, std::string_view key) {
  for (const std::string_view line : lines) {
    const std::size_t colon = key.size();
    if (line.substr(0, colon) != key || line.size() <= colon || line[colon] != ':') continue;
    const std::string_view value = line.substr(colon + 1);
    return value.substr(0, value.find(';'));
  }
  return std::nullopt;
}

bool read(const std::vector<std::string>& lines, std::string_view key, int& into) {
  const std::optional<std::string_view> text = value_of(lines, key);
  if (!text) return false;
  const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), into);
  return error == std::errc() && end == text->data() + text->size();
}

}  // namespace

char checksum(std::string_view line) {
  unsigned sum = 0;
  for (const char character : line) sum += static_cast<unsigned char>(character);
  return static_cast<char>((sum & 0x3FU) + zero);
}

std::string encode_number(std::uint32_t value, std::size_t digits) {
  std::string text(digits, zero);
  for (std::size_t i = 0; i < digits; ++i)
    text[digits - 1 - i] = static_cast<char>(zero + ((value >> (6 * i)) & 0x3FU));
  return text;
}

std::optional<std::uint32_t> decode_number(std::string_view digits) {
  std::uint32_t value = 0;
  for (const char digit : digits) {
    if (!is_digit(digit)) return std::nullopt;
    value = (value << 6U) | static_cast<std::uint32_t>(digit - zero);
  }
  return value;
}

std::string encode(const Answer& answer) {
  std::string text = answer.command + '\n' + answer.status + checksum(answer.status) + '\n';
  for (const std::string& line : answer.lines) text += line + checksum(line) + '\n';
  return text + '\n';
}

std::string encode_block(const std::string& command, const std::string& status, std::string_view data) {
  Answer answer{command, status, {}};
  for (std::size_t at = 0; at < data.size(); at += line_length)
    answer.lines.emplace_back(data.substr(at, line_length));
  return encode(answer);
}

std::optional<Answer> decode(std::string_view text) {
  Answer answer;
  for (int number = 0; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (number == 0) {
      answer.command = line;
      continue;
    }
    if (line.empty() || checksum(line.substr(0, line.size() - 1)) != line.back()) return std::nullopt;
    const std::string_view content = line.substr(0, line.size() - 1);
    if (number == 1)
      answer.status = content;
    else
      answer.lines.emplace_back(content);
  }
  if (answer.status.size() != 2) return std::nullopt;
  return answer;
}

std::optional<std::string> block_of(const Answer& answer) {
  std::string data;
  for (std::size_t i = 0; i < answer.lines.size(); ++i) {
    const bool is_last = i + 1 == answer.lines.size();
    const std::size_t length = answer.lines[i].size();
    if (length > line_length || (!is_last && length != line_length)) return std::nullopt;
    data += answer.lines[i];
  }
  return data;
}

std::vector<std::string> lines_of(const Parameters& parameters) {
  return {
      fmt::format("MODL:{};", parameters.model),        fmt::format("DMIN:{};", parameters.min_range_mm),
      fmt::format("DMAX:{};", parameters.max_range_mm), fmt::format("ARES:{};", parameters.steps_per_turn),
      fmt::format("AMIN:{};", parameters.first_step),   fmt::format("AMAX:{};", parameters.last_step),
      fmt::format("AFRT:{};", parameters.front_step),   fmt::format("SCAN:{};", parameters.turns_per_minute)};
}

std::optional<Parameters> parameters_of(const std::vector<std::string>& lines) {
  Parameters found;
  found.model = value_of(lines, "MODL").value_or("");
  for (char& character : found.model)
    if (character < ' ' || character > '~') character = '?';
  const bool is_whole = read(lines, "DMIN", found.min_range_mm) && read(lines, "DMAX", found.max_range_mm) &&
                        read(lines, "ARES", found.steps_per_turn) && read(lines, "AMIN", found.first_step) &&
                        read(lines, "AMAX", found.last_step) && read(lines, "AFRT", found.front_step) &&
                        read(lines, "SCAN", found.turns_per_minute);
  const bool is_possible = found.min_range_mm >= 0 && found.max_range_mm > found.min_range_mm &&
                           found.steps_per_turn > 0 && found.steps_per_turn <= most_steps &&
                           found.first_step >= 0 && found.last_step > found.first_step &&
                           found.last_step <= 9999 && found.front_step >= 0 && found.front_step <= 9999 &&
                           found.turns_per_minute > 0 && found.turns_per_minute <= 60000;
  if (!is_whole || !is_possible) return std::nullopt;
  return found;
}

std::string order_to_scan(const Parameters& parameters) {
  return fmt::format("MD{:04}{:04}01000", parameters.first_step, parameters.last_step);
}

}  // namespace lodestar::scip
