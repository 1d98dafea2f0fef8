#include <utility>

#include "app/navigation/mission.hpp"

// What a mission does at a goal that it has come to, before it counts as reached.
namespace lodestar {

MissionEvent Mission::arrive(Stamp now) {
  const Goal& goal = goals_[current_];
  if (goal.wait <= Duration::zero() && goal.action.empty()) return end_goal(now, MissionEvent::goal_arrived);
  state_ = AtStop{.since = now, .action_done = goal.action.empty(), .failure = {}};
  return MissionEvent::none;
}

/// A pause holds it; so does an action, which a pause does not hold. What fails there ends the drive: what
/// comes after may rely on it.
MissionEvent Mission::advance(AtStop state, const SensorInput& input, const NavigationStep&) {
  const Goal& goal = goals_[current_];
  const Duration stood = input.now - state.since.value_or(input.now);
  const bool nobody_begins = !state.action_done && !state.action_begun && stood > options_.max_action_begin;
  if (nobody_begins) state.failure = "nobody here carries it out";
  if (!state.failure.empty()) {
    const std::string why = goal.action + ": " + state.failure;
    goals_.resize(current_ + 1);
    return fail(input.now, why);
  }
  if (!state.action_done || paused_ || stood < goal.wait) return MissionEvent::none;
  return end_goal(input.now, MissionEvent::goal_arrived);
}

std::string Mission::take_action() {
  auto* const stop = std::get_if<AtStop>(&state_);
  if (finished() || stop == nullptr || stop->action_done || stop->action_begun) return {};
  stop->action_begun = true;
  return goals_[current_].action;
}

void Mission::action_ended(std::string why_failed) {
  auto* const stop = std::get_if<AtStop>(&state_);
  if (stop == nullptr || !stop->action_begun) return;
  stop->action_done = true;
  stop->failure = std::move(why_failed);
}

bool Mission::awaits_action() const {
  const auto* const stop = std::get_if<AtStop>(&state_);
  return !finished() && stop != nullptr && stop->action_begun && !stop->action_done;
}

}  // namespace lodestar
