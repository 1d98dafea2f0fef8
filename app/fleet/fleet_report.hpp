#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "app/fleet/fleet_messages.hpp"
#include "app/fleet/order_book.hpp"
#include "maps/motion.hpp"

namespace lodestar {

/// What a state message says, at one step of the robot.
struct FleetReport {
  std::string order_id;
  std::uint32_t update_id = 0;
  std::string last_node_id;
  std::uint32_t last_sequence = 0;
  std::deque<FleetNode> nodes;  ///< not yet traversed
  std::deque<FleetEdge> edges;
  std::vector<ActionRecord> actions;
  std::vector<FleetError> errors;
  std::optional<Pose2> map_from_base;  ///< nothing while the pose is unknown
  double deviation_m = 0.0;            ///< of that pose, one standard deviation
  std::string map;
  BodyVelocity velocity;
  bool driving = false;
  bool paused = false;
  bool wants_base = false;  ///< the end of the base is near, and there is a horizon
  double since_last_node_m = 0.0;
  double charge_percent = 0.0;
  bool charging = false;
  std::optional<double> battery_v;
  OperatingMode mode = OperatingMode::automatic;
  EmergencyStop emergency_stop = EmergencyStop::none;
  bool field_violation = false;  ///< the protective field stops the robot
};

}  // namespace lodestar
