#include "app/placement/exploration.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace lodestar {

Exploration::Exploration(const Site& site, const std::string& camera, const PlacedStart& start,
                         const ExplorerOptions& options)
    : start_(start), explorer_(site, camera, start, options) {}

ExplorationState Exploration::conduct(const MissionStep& step, Mission& mission,
                                      const SurveyProgress* newest) {
  if (!is_placed_) {
    is_placed_ = mission.place_robot(start_.map_from_base, {start_.sigma_m, start_.sigma_rad});
    return ExplorationState::under_way;
  }
  if (newest != nullptr) use(*newest, mission);
  if (step.navigation.stop && is_latched(*step.navigation.stop)) {
    last_failure_ = to_string(*step.navigation.stop);
    return ExplorationState::robot_lost;
  }
  if (step.event == MissionEvent::goal_arrived) explorer_.reached();
  if (step.event == MissionEvent::goal_failed) {
    last_failure_ = mission.failure();
    const auto& estimate = step.navigation.estimate;
    explorer_.failed(estimate ? std::optional<Vec2>(estimate->map_from_base.position_m) : std::nullopt);
  }
  if (!mission.finished() || !step.navigation.estimate) return ExplorationState::under_way;
  const std::optional<Goal> goal = explorer_.next(step.navigation.estimate->map_from_base.position_m, newest);
  if (!goal) return when_nothing_is_left(newest);
  at_the_end_.reset();
  mission.start({*goal});
  return ExplorationState::under_way;
}

/// What was driven last is in the estimate after the one that may have been under way then.
ExplorationState Exploration::when_nothing_is_left(const SurveyProgress* newest) {
  constexpr std::uint64_t under_way = 1;
  if (newest != nullptr) {
    if (!at_the_end_) at_the_end_ = newest->number;
    if (newest->number <= *at_the_end_ + under_way) return ExplorationState::under_way;
  }
  return shortcomings(newest).empty() ? ExplorationState::done : ExplorationState::incomplete;
}

std::vector<std::string> Exploration::shortcomings(const SurveyProgress* newest) const {
  std::vector<std::string> lines;
  if (newest == nullptr || newest->survey.markers.empty()) lines.emplace_back("no marker was surveyed");
  if (explorer_.lanes_given_up() > 0)
    lines.push_back(fmt::format("{} lanes could not be driven", explorer_.lanes_given_up()));
  if (newest == nullptr) return lines;
  for (const SurveyRefusal& flaw : newest->survey.flaws)
    lines.push_back(fmt::format("{}: {}", to_string(flaw.flaw), flaw.found));
  if (const std::vector<int> weak = markers_above_target(*newest); !weak.empty())
    lines.push_back(fmt::format("tied to their neighbours less well than to {:.1f} mm: markers {}",
                                mm_per_m * newest->target_sigma_m, fmt::join(weak, ", ")));
  return lines;
}

/// A survey that contradicts itself is no registry; the one before stays in use.
void Exploration::use(const SurveyProgress& newest, Mission& mission) {
  if (newest.number == used_ || !newest.survey.flaws.empty()) return;
  used_ = newest.number;
  mission.registry_changed(registry_so_far(newest));
}

}  // namespace lodestar
