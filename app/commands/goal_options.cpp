#include "app/commands/goal_options.hpp"

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

std::vector<Goal> goals_in(const GoalArguments& arguments, const Places& places) {
  return goals_in(arguments.goals, arguments.mission, places);
}

}  // namespace lodestar
