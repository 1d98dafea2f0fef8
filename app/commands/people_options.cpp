#include "app/commands/people_options.hpp"

#include <fmt/format.h>

#include "app/simulate/simulated_drive.hpp"

namespace lodestar {

void add_people_options(CLI::App& command, PeopleArguments& arguments) {
  CLI::Option* people =
      command.add_option("--people", arguments.count, "So many people walk about; the robot gets a scanner")
          ->check(CLI::Range(0, 100));
  command
      .add_option(
          "--people-kind", arguments.kind,
          "ordinary (keep off the robot), oblivious (do not see it), threatening (step in its way) or "
          "mixed")
      ->check(CLI::IsMember({"ordinary", "oblivious", "threatening", "mixed"}))
      ->needs(people)
      ->capture_default_str();
}

void use_people(const PeopleArguments& arguments, SimulatedDriveOptions& options) {
  if (arguments.count == 0) return;
  options.people.count = arguments.count;
  if (arguments.kind != "mixed") {
    options.people.oblivious_share = arguments.kind == "oblivious" ? 1.0 : 0.0;
    options.people.threatening_share = arguments.kind == "threatening" ? 1.0 : 0.0;
  }
}

std::string words_of(const PeopleArguments& arguments) {
  if (arguments.count == 0) return {};
  return fmt::format(" --people {} --people-kind {}", arguments.count, arguments.kind);
}

}  // namespace lodestar
