#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

namespace lodestar {

/// A finite number that is all of the text.
inline std::optional<double> finite_number(std::string_view text) {
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  const bool usable = error == std::errc() && rest == end && std::isfinite(value);
  return usable ? std::optional(value) : std::nullopt;
}

/// The finite numbers of a line, separated by commas; nothing for any other line.
template <std::size_t count>
std::optional<std::array<double, count>> csv_numbers(std::string_view line) {
  std::array<double, count> numbers{};
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t comma = line.find(',');
    if ((comma == std::string_view::npos) != (i + 1 == count)) return std::nullopt;
    const std::optional<double> number = finite_number(line.substr(0, comma));
    if (!number) return std::nullopt;
    numbers[i] = *number;
    line.remove_prefix(std::min(line.size(), comma == std::string_view::npos ? line.size() : comma + 1));
  }
  return numbers;
}

/// Seconds that a stamp can hold.
inline bool is_stamp(double value_s) {
  constexpr double far_future_s = 9e9;
  return std::abs(value_s) <= far_future_s;
}

}  // namespace lodestar
