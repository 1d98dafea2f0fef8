#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "app/live/robot_state.hpp"
#include "app/net/socket.hpp"

// JSON of the page's protocol: the robot's state to the page, goals from it, in metres, degrees and seconds.
namespace lodestar {

/// As it is sent; what is no UTF-8 is replaced.
SocketMessage message_of(const nlohmann::ordered_json& content);

nlohmann::ordered_json state_json(const RobotState& state);

/// What the scanner sees, in the map where the pose is known: {"type", "cell_m", "cell_yaw_deg", "mapped",
/// "standing", "person", "hidden", "cells_standing", "cells_moving"}, each of the last six a list of
/// x, y, x, y, ... in metres.
nlohmann::ordered_json seen_json(const RobotState& state);

/// [[x_m, y_m], ...]
nlohmann::ordered_json points_json(const Path& path);

/// Reads [[x_m, y_m], [x_m, y_m, yaw_deg], ...]. Throws InputError for anything else, for an empty list and
/// for more than 100 goals.
std::vector<Goal> goals_from_json(const nlohmann::json& goals);

/// The words of a client about itself, which others read.
std::string name_from_json(const nlohmann::json& message);

/// {"forward_mps": ..., "turn_degps": ...}. Throws InputError for what is no velocity.
BodyVelocity velocity_from_json(const nlohmann::json& message);

/// Reads [x_m, y_m, yaw_deg]. Throws InputError for anything else.
Pose2 pose_from_json(const nlohmann::json& pose);

}  // namespace lodestar
