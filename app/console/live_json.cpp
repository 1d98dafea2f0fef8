#include "app/console/live_json.hpp"

#include <cmath>

#include "app/common/json_text.hpp"
#include "app/common/rounding.hpp"
#include "maps/input_error.hpp"

namespace lodestar {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

/// To 0.1 mm, 0.1 mm/s or 1e-4 degrees.
double short_number(double value) {
  return rounded(value, 1e4);
}

ordered_json velocity_json(const BodyVelocity& velocity) {
  return {{"forward_mps", short_number(velocity.forward_mps)},
          {"turn_degps", short_number(degrees(velocity.turn_radps))}};
}

ordered_json estimate_json(const PoseEstimate& estimate) {
  const Pose2& pose = estimate.map_from_base;
  const Eigen::Matrix3d& covariance = estimate.covariance;
  return {{"x_m", rounded(pose.position_m.x(), 1e5)},
          {"y_m", rounded(pose.position_m.y(), 1e5)},
          {"yaw_deg", rounded(degrees(pose.yaw_rad), 1e3)},
          {"covariance_m2", {covariance(0, 0), covariance(0, 1), covariance(1, 1)}},
          {"sigma_yaw_deg", short_number(degrees(std::sqrt(std::max(covariance(2, 2), 0.0))))}};
}

ordered_json goal_json(const Goal& goal) {
  ordered_json numbers{goal.position_m.x(), goal.position_m.y()};
  if (goal.heading_rad) numbers.push_back(short_number(degrees(*goal.heading_rad)));
  return numbers;
}

template <typename Value>
ordered_json or_null(const std::optional<Value>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

double number_in(const json& value, double limit) {
  if (!value.is_number() || !(std::abs(value.get<double>()) <= limit)) {
    throw InputError("found '" + value.dump().substr(0, 60) + "', wanted a number in metres or degrees");
  }
  return value.get<double>();
}

Goal goal_from_json(const json& goal) {
  if (!goal.is_array() || goal.size() < 2 || goal.size() > 3)
    throw InputError("wanted [x_m, y_m] or [x_m, y_m, yaw_deg]");
  Goal read{Vec2(number_in(goal[0], far_m), number_in(goal[1], far_m)), std::nullopt};
  if (goal.size() == 3) read.heading_rad = wrap_angle(radians(number_in(goal[2], 360.0)));
  return read;
}

/// What the protective field does, and why; null without a scanner.
ordered_json field_json(const RobotState& state) {
  if (!state.seen) return nullptr;
  const bool stands = state.stop && waits_for_others(*state.stop);
  const std::optional<StopReason> why = stands ? state.stop : state.slowed_by;
  return {{"state", stands ? "stopped"
                    : why  ? "slowed"
                           : "free"},
          {"why", why ? ordered_json(to_string(*why)) : ordered_json(nullptr)}};
}

const char* list_of(Presence presence) {
  switch (presence) {
    case Presence::mapped:
      return "mapped";
    case Presence::standing:
      return "standing";
    case Presence::legs:
    case Presence::waiting:
    case Presence::person:
      return "person";
    case Presence::hidden:
      return "hidden";
  }
  return "person";
}

/// To a centimetre: the scanner knows no better, and there are hundreds.
void add_point(ordered_json& list, const Vec2& point_m) {
  list.push_back(rounded(point_m.x(), 1e2));
  list.push_back(rounded(point_m.y(), 1e2));
}

}  // namespace

ordered_json seen_json(const RobotState& state) {
  ordered_json out{{"type", "seen"}};
  for (const char* const name : {"mapped", "standing", "person", "hidden", "cells_standing", "cells_moving"})
    out[name] = ordered_json::array();
  if (!state.seen || !state.estimate) return out;
  const SeenSurroundings& seen = *state.seen;
  const Pose2& map_from_base = state.estimate->map_from_base;
  const Pose2 map_from_odom = map_from_base * seen.base_from_odom;
  out["cell_m"] = seen.cell_m;
  out["cell_yaw_deg"] = short_number(degrees(map_from_odom.yaw_rad));
  for (const SeenPoint& point : seen.points)
    add_point(out[list_of(point.presence)], map_from_base * point.point_in_base);
  for (const RememberedCell& cell : seen.cells)
    add_point(out[cell.stands ? "cells_standing" : "cells_moving"], map_from_odom * cell.center_in_odom);
  return out;
}

SocketMessage message_of(const ordered_json& content) {
  return text_message(json_text(content));
}

ordered_json state_json(const RobotState& state) {
  ordered_json out{{"type", "state"},
                   {"time_s", short_number(seconds(state.now))},
                   {"pose", state.estimate ? estimate_json(*state.estimate) : ordered_json(nullptr)},
                   {"commanded", velocity_json(state.commanded)},
                   {"measured", state.measured ? velocity_json(*state.measured) : ordered_json(nullptr)},
                   {"phase", to_string(state.phase)},
                   {"moving", state.phase != MissionPhase::idle},
                   {"paused", state.phase == MissionPhase::paused},
                   {"goals", ordered_json::array()},
                   {"current", state.current},
                   {"stop", state.stop ? ordered_json(to_string(*state.stop)) : ordered_json(nullptr)},
                   {"field", field_json(state)},
                   {"base", to_string(state.base)},
                   {"base_ready", state.base == BaseState::ready},
                   {"fault", state.fault ? ordered_json(in_words(*state.fault, state.fault_details))
                                         : ordered_json(nullptr)},
                   {"battery_v", or_null(state.battery_v)},
                   {"charging", to_string(state.charging)},
                   {"markers", state.markers},
                   {"confidence", short_number(state.confidence)},
                   {"seen_s", state.last_seen ? ordered_json(short_number(seconds(*state.last_seen)))
                                              : ordered_json(nullptr)},
                   {"distrusted", ordered_json::array()},
                   {"error_m", state.error ? ordered_json(state.error->position_m) : ordered_json(nullptr)},
                   {"events", ordered_json::array()}};
  for (const Goal& goal : state.goals) out["goals"].push_back(goal_json(goal));
  for (const DistrustedMarker& marker : state.distrusted) out["distrusted"].push_back(marker.id);
  for (const DriveEvent& event : state.events) {
    out["events"].push_back(
        {{"number", event.number}, {"time_s", short_number(seconds(event.stamp))}, {"words", event.words}});
  }
  return out;
}

ordered_json points_json(const Path& path) {
  ordered_json points = ordered_json::array();
  for (const Vec2& point : path.waypoints_m)
    points.push_back({short_number(point.x()), short_number(point.y())});
  return points;
}

std::vector<Goal> goals_from_json(const json& goals) {
  constexpr std::size_t most_goals = 100;
  if (!goals.is_array() || goals.empty() || goals.size() > most_goals)
    throw InputError("wanted 1 to 100 goals");
  std::vector<Goal> read;
  for (const json& goal : goals) read.push_back(goal_from_json(goal));
  return read;
}

std::string name_from_json(const json& message) {
  constexpr std::size_t longest = 40;
  const auto name = message.at("name").get<std::string>();
  if (name.size() > longest) throw InputError("found a long name, wanted at most 40 bytes");
  return name;
}

BodyVelocity velocity_from_json(const json& message) {
  return {number_in(message.at("forward_mps"), 10.0), radians(number_in(message.at("turn_degps"), 1000.0))};
}

Pose2 pose_from_json(const json& pose) {
  const Goal read = goal_from_json(pose);
  if (!read.heading_rad) throw InputError("wanted [x_m, y_m, yaw_deg]");
  return {read.position_m, *read.heading_rad};
}

}  // namespace lodestar
