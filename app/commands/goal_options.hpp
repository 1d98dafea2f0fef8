#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "app/site/goal.hpp"
#include "maps/places.hpp"

namespace lodestar {

/// Where to drive, as the command line names it: goals in turn, or a mission of places.yaml.
struct GoalArguments {
  std::vector<std::string> goals;
  std::string mission;

  [[nodiscard]] bool empty() const { return goals.empty() && mission.empty(); }
};

/// `--goal` and `--mission`. Fills the arguments, which must outlive the application. `otherwise` is the end
/// of what is said of --goal.
void add_goal_options(CLI::App& command, GoalArguments& arguments, const std::string& otherwise = {});

/// The options that lead to these goals again, with a space before each.
std::string words_of(const GoalArguments& arguments, const std::vector<Goal>& goals);

/// In driving order. Throws InputError where a name is unknown.
std::vector<Goal> goals_in(const GoalArguments& arguments, const Places& places);

}  // namespace lodestar
