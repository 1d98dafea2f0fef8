#include "app/commands/people_options.hpp"

#include <fmt/format.h>

#include "app/campaign/random_obstacles.hpp"
#include "maps/input_error.hpp"

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
  command.add_flag(
      "--obstacles", arguments.obstacles,
      "Boxes, chairs and perhaps a sliding door that the map lacks, drawn from the seed; the robot "
      "gets a scanner");
}

void use_people(const PeopleArguments& arguments, const Site& site, SimulatedDriveOptions& options) {
  if (arguments.obstacles) {
    if (options.goals.empty())
      throw InputError("--obstacles: found no goal, wanted one to which they leave a way");
    Site driven = site;
    driven.goals = options.goals;
    add_random_obstacles(driven, options.seed, options);
  }
  options.people.count = arguments.count;
  if (arguments.kind != "mixed") {
    options.people.oblivious_share = arguments.kind == "oblivious" ? 1.0 : 0.0;
    options.people.threatening_share = arguments.kind == "threatening" ? 1.0 : 0.0;
  }
}

std::string words_of(const PeopleArguments& arguments) {
  std::string words = arguments.obstacles ? " --obstacles" : "";
  if (arguments.count > 0)
    words += fmt::format(" --people {} --people-kind {}", arguments.count, arguments.kind);
  return words;
}

}  // namespace lodestar
