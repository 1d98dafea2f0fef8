#include "app/commands/goal_options.hpp"

#include <fmt/core.h>

#include "app/commands/shell_quoting.hpp"
#include "app/site/arguments.hpp"

namespace lodestar {

void add_goal_options(CLI::App& command, GoalArguments& arguments, const std::string& otherwise) {
  CLI::Option* goal = command.add_option(
      "--goal", arguments.goals,
      "X,Y[,DEG] in metres and degrees, or the name of a place; repeat for more" + otherwise);
  goal->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command
      .add_option("--mission", arguments.mission,
                  "Drive to the places of this mission of places.yaml in turn")
      ->excludes(goal);
}

std::string words_of(const GoalArguments& arguments, const std::vector<Goal>& goals) {
  if (!arguments.mission.empty()) return " --mission " + shell_quoted(arguments.mission);
  std::string words;
  for (const Goal& goal : goals) {
    if (goal.passes) continue;  // a point of the route graph
    words += fmt::format(" --goal {},{}", goal.position_m.x(), goal.position_m.y());
    if (goal.heading_rad) words += fmt::format(",{:.9g}", degrees(*goal.heading_rad));
  }
  return words;
}

std::vector<Goal> goals_in(const GoalArguments& arguments, const Places& places) {
  return goals_in(arguments.goals, arguments.mission, places);
}

}  // namespace lodestar
