#include "app/commands/strict_arguments.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <vector>

namespace lodestar {
namespace {

/// The whole text as a number, in decimal.
template <typename Number>
std::optional<Number> number_from(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  Number number{};
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || rest != end) return std::nullopt;
  return number;
}

std::string refusal(const std::string& text, std::string_view wanted) {
  return fmt::format("found '{}', wanted {}", text, wanted);
}

std::string refuse_real(const std::string& text) {
  const std::optional<double> number = number_from<double>(text);
  return number && std::isfinite(*number) ? "" : refusal(text, "a finite number");
}

std::string refuse_integer(const std::string& text) {
  return number_from<std::int64_t>(text) ? "" : refusal(text, "a whole number");
}

std::string refuse_unsigned(const std::string& text) {
  return number_from<std::uint64_t>(text) ? "" : refusal(text, "a whole number, 0 or more");
}

using Refusal = std::string (*)(const std::string&);

/// By the type that CLI11 derives from the variable behind the option.
std::optional<Refusal> refusal_for(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  if (type.starts_with("FLOAT")) return refuse_real;
  if (type.starts_with("INT")) return refuse_integer;
  if (type.starts_with("UINT")) return refuse_unsigned;
  return std::nullopt;
}

std::size_t edit_distance(std::string_view a, std::string_view b) {  // Wagner and Fischer 1974
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j < row.size(); ++j) row[j] = j;
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

void refuse_unusual_numbers(CLI::App& app) {
  for (CLI::Option* const option : app.get_options()) {
    if (const std::optional<Refusal> refuse = refusal_for(*option))
      option->check(CLI::Validator(*refuse, ""));
  }
  for (CLI::App* const command : app.get_subcommands([](CLI::App*) { return true; }))
    refuse_unusual_numbers(*command);
}

std::optional<std::string> unknown_command(const CLI::App& app, int argc, char** argv) {
  if (argc < 2) return std::nullopt;
  const std::string given = argv[1];
  if (given.starts_with('-')) return std::nullopt;

  std::string nearest;
  std::size_t distance = 1 + given.size() / 2;  // more edits than that are another word
  for (const CLI::App* const command : app.get_subcommands([](const CLI::App*) { return true; })) {
    const std::size_t edits = edit_distance(given, command->get_name());
    if (edits == 0) return std::nullopt;
    if (edits >= distance) continue;
    distance = edits;
    nearest = command->get_name();
  }
  const std::string hint = nearest.empty() ? "a command of lodestar --help" : nearest + "?";
  return fmt::format("found '{}', wanted {}", given.substr(0, 60), hint);
}

}  // namespace lodestar
