#include "app/fleet/stop_actions.hpp"

#include <chrono>
#include <fmt/format.h>
#include <thread>

namespace lodestar {

StopActions::StopActions(const Site& site, bool waits, std::function<void(const std::string&)> tell)
    : hooks_(site.actions, site.folder), waits_(waits), tell_(std::move(tell)) {}

void StopActions::attend(Mission& mission) {
  if (const std::string type = mission.take_action(); !type.empty()) begin(type, mission);
  if (running_.empty()) return;
  if (!mission.awaits_action()) running_.clear();  // the drive was stopped meanwhile: so is the program
  hooks_.keep([this](const std::string& id) { return id == running_; });
  do {
    hear(mission);
    if (waits_ && !running_.empty()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  } while (waits_ && !running_.empty());
}

void StopActions::begin(const std::string& type, Mission& mission) {
  if (!hooks_.carries_out(type)) return mission.action_ended("site.yaml has no program for it");
  running_ = fmt::format("stop-{}", ++count_);
  type_ = type;
  const Goal& goal = mission.goals()[mission.current()];
  FleetAction action{.id = running_, .type = type, .parameters = {}};
  action.parameters["x"] = fmt::format("{}", goal.position_m.x());
  action.parameters["y"] = fmt::format("{}", goal.position_m.y());
  if (goal.heading_rad) action.parameters["theta"] = fmt::format("{}", *goal.heading_rad);
  if (tell_) tell_(type + " begins");
  hooks_.start(action);
}

void StopActions::hear(Mission& mission) {
  for (const HookResult& result : hooks_.take_ended()) {
    if (result.action_id != running_) continue;
    running_.clear();
    const std::string words = result.words.empty() ? (result.succeeded ? "done" : "failed") : result.words;
    if (tell_) tell_(type_ + ": " + words);
    mission.action_ended(result.succeeded ? "" : words);
  }
}

}  // namespace lodestar
