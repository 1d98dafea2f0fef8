#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/commands/command_pages.hpp"

namespace lodestar {
namespace {

/// Text that man(7) shows as it is: no escapes, hyphens that can be copied, no line that begins with a
/// control character.
std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if ((c == '.' || c == '\'') && (result.empty() || result.back() == '\n')) result += "\\&";
    if (c == '\\')
      result += "\\e";
    else if (c == '-')
      result += "\\-";
    else
      result += c;
  }
  return result;
}

/// The description up to its first full stop or semicolon, for the line that apropos(1) lists.
std::string summary(const std::string& description) {
  return description.substr(0, std::min(description.find(';'), description.find(". ")));
}

std::string in_brackets(const OptionPage& option) {
  std::string text = fmt::format("\\fI{}\\fR{}", escaped(option.positional), option.may_repeat ? "..." : "");
  return option.is_required ? text : "[" + text + "]";
}

std::string synopsis(const CommandPage& page) {
  std::string text = fmt::format(".B {}\n", escaped(fmt::format("{}", fmt::join(page.words, " "))));
  text += page.subcommands.empty() ? "[\\fIOPTIONS\\fR]" : "\\fICOMMAND\\fR [\\fIOPTIONS\\fR]";
  for (const OptionPage& option : page.options)
    if (!option.positional.empty()) text += " " + in_brackets(option);
  return text + "\n";
}

std::string tag(const OptionPage& option) {
  if (!option.positional.empty()) return fmt::format("\\fI{}\\fR", escaped(option.positional));
  std::vector<std::string> names;
  for (const std::string& name : option.names) names.push_back("\\fB" + escaped(name) + "\\fR");
  std::string text = fmt::format("{}", fmt::join(names, ", "));
  if (!option.value.empty()) text += " \\fI" + escaped(option.value) + "\\fR";
  return text;
}

std::string entry(const OptionPage& option) {
  std::string text = fmt::format(".TP\n{}\n{}\n", tag(option), escaped(option.description));
  if (!option.choices.empty())
    text += fmt::format(".br\nOne of: {}.\n", escaped(fmt::format("{}", fmt::join(option.choices, ", "))));
  if (!option.initial.empty()) text += fmt::format(".br\nDefault: {}.\n", escaped(option.initial));
  if (!option.environment.empty())
    text += fmt::format(".br\nThe environment's {} sets it too.\n", escaped(option.environment));
  return text;
}

std::string entries(const CommandPage& page, bool are_positional) {
  std::string text;
  for (const OptionPage& option : page.options)
    if (option.positional.empty() != are_positional) text += entry(option);
  return text;
}

std::string section(std::string_view title, const std::string& content) {
  return content.empty() ? "" : fmt::format(".SH {}\n{}", title, content);
}

std::string commands(const CommandPage& page) {
  std::string text;
  for (const CommandPage& inner : page.subcommands)
    text += fmt::format(".TP\n.BR {} (1)\n{}\n", escaped(manual_name(inner)), escaped(inner.description));
  return text;
}

/// The program's own page, and that of the command that this one is a part of.
std::string see_also(const CommandPage& page) {
  if (page.words.size() < 2) return "";
  std::string text = ".BR lodestar (1)";
  if (page.words.size() > 2)
    text += ",\n.BR " + escaped(fmt::format("{}", fmt::join(page.words.begin(), page.words.end() - 1, "-"))) +
            " (1)";
  return text + "\n";
}

constexpr std::string_view exit_status =
    ".TP\n0\nDone.\n.TP\n1\nThe job failed: no path, not arrived, a check found errors.\n"
    ".TP\n2\nUnusable input or arguments; the message says what was found, what was wanted, and where.\n";

constexpr std::string_view files =
    ".TP\n\\fI/etc/lodestar/SITE\\fR, \\fI/srv/lodestar/SITE\\fR\nSites that commands find by their name.\n"
    ".TP\n\\fI/usr/share/lodestar/sites/lab\\fR\nThe example site, where commands are given none.\n";

}  // namespace

std::string manual_name(const CommandPage& page) {
  return fmt::format("{}", fmt::join(page.words, "-"));
}

std::string manual_page(const CommandPage& page, std::string_view version) {
  std::string title = manual_name(page);
  const std::string name = escaped(title) + " \\- " + escaped(summary(page.description)) + "\n";
  std::ranges::transform(title, title.begin(),
                         [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return fmt::format(".TH {} 1 \"\" \"lodestar {}\" Lodestar\n", escaped(title), version) +
         section("NAME", name) + section("SYNOPSIS", synopsis(page)) +
         section("DESCRIPTION", escaped(page.description) + ".\n") + section("COMMANDS", commands(page)) +
         section("ARGUMENTS", entries(page, true)) + section("OPTIONS", entries(page, false)) +
         section("\"EXIT STATUS\"", std::string(exit_status)) + section("FILES", std::string(files)) +
         section("\"SEE ALSO\"", see_also(page));
}

}  // namespace lodestar
