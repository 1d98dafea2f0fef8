#include "app/site/arguments.hpp"

#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <vector>

#include "maps/input_error.hpp"

namespace lodestar {
namespace {

/// The finite numbers between the commas; nothing when a part is no such number.
std::optional<std::vector<double>> numbers_in(const std::string& text) {
  std::vector<double> numbers;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (true) {
    double number = 0.0;
    const auto [rest, error] = std::from_chars(at, end, number);
    if (error != std::errc() || !std::isfinite(number)) return std::nullopt;
    numbers.push_back(number);
    if (rest == end) return numbers;
    if (*rest != ',') return std::nullopt;
    at = rest + 1;
  }
}

}  // namespace

Vec2 parse_point(const std::string& option, const std::string& text) {
  const auto numbers = numbers_in(text);
  if (!numbers || numbers->size() != 2) {
    throw InputError(fmt::format("{}: found '{}', wanted X,Y in metres", option, text));
  }
  return {(*numbers)[0], (*numbers)[1]};
}

Goal parse_goal(const std::string& option, const std::string& text) {
  const auto numbers = numbers_in(text);
  if (!numbers || numbers->size() < 2 || numbers->size() > 3) {
    throw InputError(
        fmt::format("{}: found '{}', wanted X,Y or X,Y,DEG in metres and degrees", option, text));
  }
  Goal goal{{(*numbers)[0], (*numbers)[1]}, std::nullopt};
  if (numbers->size() == 3) goal.heading_rad = wrap_angle(radians((*numbers)[2]));
  return goal;
}

}  // namespace lodestar
