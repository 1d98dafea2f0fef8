#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace lodestar {

/// An option, a flag or a positional argument of the command line, as its documentation shows it.
struct OptionPage {
  std::vector<std::string> names;  ///< "-o", "--output"; none for a positional argument
  std::string positional;          ///< its name; empty for an option
  std::string value;               ///< what it takes: "UINT", "FILE"; empty for a flag
  std::vector<std::string> choices;
  std::string initial;  ///< the value when left out, if it is shown
  std::string description;
  std::string environment;  ///< variable that sets it; empty for none
  bool is_required = false;
  bool may_repeat = false;  ///< takes several values
};

/// A command with its options and subcommands.
struct CommandPage {
  std::vector<std::string> words;  ///< as typed: {"lodestar", "markers", "check"}
  std::string description;
  std::vector<OptionPage> options;
  std::vector<CommandPage> subcommands;
};

/// The whole command line of the program, without what its help hides.
CommandPage command_tree(const CLI::App& app);

/// The page and those of all its subcommands, in the order of the help.
std::vector<const CommandPage*> all_pages(const CommandPage& page);

}  // namespace lodestar
