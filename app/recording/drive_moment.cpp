#include "app/recording/drive_moment.hpp"

#include <fmt/format.h>

namespace lodestar {

namespace {

std::string path_in_words(const Mission& mission) {
  const Path& path = mission.path();
  const Vec2& goal_m = mission.goals()[mission.current()].position_m;
  const double short_by_m = (path.waypoints_m.back() - goal_m).norm();
  std::string words = fmt::format("goal {}: a path of {:.2f} m", mission.current() + 1, length_m(path));
  if (!mission.goals()[mission.current()].passes && short_by_m > 1e-6)
    words += fmt::format(", to {:.0f} mm beside the goal, which touches an obstacle", 1e3 * short_by_m);
  return words;
}

}  // namespace

std::string in_words(const Mission& mission, MissionEvent event) {
  switch (event) {
    case MissionEvent::none:
      return "";
    case MissionEvent::path_planned:
      return path_in_words(mission);
    case MissionEvent::goal_passed:
      return fmt::format("goal {}: passed", mission.current());
    case MissionEvent::goal_arrived:
      return fmt::format("goal {}: arrived", mission.current());
    case MissionEvent::goal_failed:
      return fmt::format("goal {}: failed: {}", mission.current(), mission.failure());
  }
  return "";
}

std::string in_words(BaseState state, const std::optional<BaseFault>& fault, const std::string& details) {
  if (!fault) return std::string(to_string(state));
  return fmt::format("{} ({})", to_string(state), in_words(*fault, details));
}

}  // namespace lodestar
