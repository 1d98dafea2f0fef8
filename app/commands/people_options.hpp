#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace lodestar {

struct SimulatedDriveOptions;

/// People who walk about in a simulated drive, as the command line names them.
struct PeopleArguments {
  int count = 0;
  std::string kind = "mixed";
};

void add_people_options(CLI::App& command, PeopleArguments& arguments);

/// With people, and with a scanner at the robot's mount, at its default figures, to see them.
void use_people(const PeopleArguments& arguments, SimulatedDriveOptions& options);

/// The options that give these people; empty without any.
std::string words_of(const PeopleArguments& arguments);

}  // namespace lodestar
