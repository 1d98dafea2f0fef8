#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/commands/command_pages.hpp"

namespace lodestar {
namespace {

/// The words after the program's name, each after a blank, as both scripts collect them from the line: "
/// markers check".
std::string place_of(const CommandPage& page) {
  std::string place;
  for (std::size_t i = 1; i < page.words.size(); ++i) place += " " + page.words[i];
  return place;
}

/// In single quotes for a shell.
std::string in_quotes(std::string_view text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

/// One pattern for each subcommand: it moves the place further down.
std::string places(const CommandPage& program) {
  std::string patterns;
  for (const CommandPage* const page : all_pages(program)) {
    if (page->words.size() < 2) continue;
    patterns += (patterns.empty() ? "" : " | ") + in_quotes(place_of(*page));
  }
  return patterns;
}

/// The values of options that are one of a list: `command` offers them, then the function ends.
std::string choices(const CommandPage& program, std::string_view command, std::string_view after) {
  std::string cases;
  for (const CommandPage* const page : all_pages(program)) {
    for (const OptionPage& option : page->options) {
      if (option.choices.empty()) continue;
      for (const std::string& name : option.names)
        cases += fmt::format("    {}) {}{}{} return ;;\n", in_quotes(place_of(*page) + " " + name), command,
                             fmt::join(option.choices, " "), after);
    }
  }
  return cases;
}

/// What may stand at the place: subcommands, or else options.
std::vector<std::string> wanted_words(const CommandPage& page) {
  std::vector<std::string> words;
  for (const CommandPage& inner : page.subcommands) words.push_back(inner.words.back());
  for (const OptionPage& option : page.options)
    words.insert(words.end(), option.names.begin(), option.names.end());
  return words;
}

/// `'NAME:DESCRIPTION'` for zsh's _describe, in which a colon ends the name.
std::string described(std::string_view name, std::string_view description) {
  return " " + in_quotes(fmt::format("{}:{}", name, description));
}

std::string zsh_words(const CommandPage& page) {
  std::string words;
  for (const CommandPage& inner : page.subcommands) words += described(inner.words.back(), inner.description);
  for (const OptionPage& option : page.options)
    for (const std::string& name : option.names) words += described(name, option.description);
  return words;
}

}  // namespace

std::string bash_completion(const CommandPage& program) {
  std::string words;
  for (const CommandPage* const page : all_pages(program))
    words += fmt::format("    {}) words={} ;;\n", in_quotes(place_of(*page)),
                         in_quotes(fmt::format("{}", fmt::join(wanted_words(*page), " "))));
  return fmt::format(R"(# Completion of lodestar's command line for bash, made by the program itself.
_lodestar() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}} place="" words="" i
  for ((i = 1; i < COMP_CWORD; ++i)); do
    case "$place ${{COMP_WORDS[i]}}" in
      {}) place+=" ${{COMP_WORDS[i]}}" ;;
    esac
  done
  case "$place $before" in
{}  esac
  case $place in
{}  esac
  # Without an answer bash offers files.
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
  if [[ -z $word && $words != [a-z]* ]]; then COMPREPLY=(); fi
}}
complete -o default -F _lodestar lodestar
)",
                     places(program),
                     choices(program, "mapfile -t COMPREPLY < <(compgen -W '", "' -- \"$word\");"), words);
}

std::string zsh_completion(const CommandPage& program) {
  std::string words;
  for (const CommandPage* const page : all_pages(program))
    words += fmt::format("  {}) wanted=({} ) ;;\n", in_quotes(place_of(*page)), zsh_words(*page));
  return fmt::format(R"(#compdef lodestar
# Completion of lodestar's command line for zsh, made by the program itself.
_lodestar() {{
  local place="" word
  local -a wanted
  for word in "${{(@)words[2,CURRENT-1]}}"; do
    case "$place $word" in
      {}) place+=" $word" ;;
    esac
  done
  case "$place ${{words[CURRENT-1]}}" in
{}  esac
  case $place in
{}  esac
  if [[ $PREFIX == -* || ${{wanted[1]}} != -* ]]; then
    _describe lodestar wanted && return
  fi
  _files
}}
_lodestar "$@"
)",
                     places(program), choices(program, "compadd -- ", ";"), words);
}

}  // namespace lodestar
