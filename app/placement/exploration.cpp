#include "app/placement/exploration.hpp"

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
    explorer_.failed();
  }
  if (!mission.finished() || !step.navigation.estimate) return ExplorationState::under_way;
  const std::optional<Goal> goal = explorer_.next(step.navigation.estimate->map_from_base.position_m, newest);
  if (!goal) return ExplorationState::done;
  mission.start({*goal});
  return ExplorationState::under_way;
}

/// A survey that contradicts itself is no registry; the one before stays in use.
void Exploration::use(const SurveyProgress& newest, Mission& mission) {
  if (newest.number == used_ || !newest.survey.flaws.empty()) return;
  used_ = newest.number;
  mission.registry_changed(registry_so_far(newest));
}

}  // namespace lodestar
