#include "app/drive_moment.hpp"

#include <fmt/format.h>

namespace lodestar {

std::string in_words(const Mission& mission, MissionEvent event) {
  switch (event) {
    case MissionEvent::none:
      return "";
    case MissionEvent::path_planned:
      return fmt::format("goal {}: a path of {:.2f} m", mission.current() + 1, length_m(mission.path()));
    case MissionEvent::goal_arrived:
      return fmt::format("goal {}: arrived", mission.current());
    case MissionEvent::goal_failed:
      return fmt::format("goal {}: failed: {}", mission.current(), mission.failure());
  }
  return "";
}

}  // namespace lodestar
