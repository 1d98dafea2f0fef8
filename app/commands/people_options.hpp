#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace lodestar {

struct Site;
struct SimulatedDriveOptions;

/// People who walk about in a simulated drive, and things that its map lacks, as the command line names them.
struct PeopleArguments {
  int count = 0;
  std::string kind = "mixed";
  bool obstacles = false;

  /// The robot needs a scanner to see them.
  [[nodiscard]] bool any() const { return count > 0 || obstacles; }
};

void add_people_options(CLI::App& command, PeopleArguments& arguments);

/// With people, and with obstacles that leave a way to the first of the options' goals. Throws InputError
/// where there is no goal.
void use_people(const PeopleArguments& arguments, const Site& site, SimulatedDriveOptions& options);

/// The options that give these people and things; empty without any.
std::string words_of(const PeopleArguments& arguments);

}  // namespace lodestar
