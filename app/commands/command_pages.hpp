#pragma once

#include <string>
#include <string_view>

#include "app/commands/command_tree.hpp"

// What the command line's tree is rendered to for a package: nothing of it is written by hand.
namespace lodestar {

/// The page's name in the manual: "lodestar-markers-check".
std::string manual_name(const CommandPage& page);

/// A page of section 1 in man(7)'s language, for one command.
std::string manual_page(const CommandPage& page, std::string_view version);

/// A script for bash-completion: names of commands and options, and the values of options that are one of a
/// list; names of files for all else.
std::string bash_completion(const CommandPage& program);

/// The same as a completion function of zsh, with descriptions.
std::string zsh_completion(const CommandPage& program);

}  // namespace lodestar
