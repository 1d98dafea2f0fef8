#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "app/live/robot_state.hpp"

// The robot's state as the page gets it, and goals as the page sends them: metres, degrees, seconds.
namespace lodestar {

nlohmann::ordered_json state_json(const RobotState& state);

/// [[x_m, y_m], ...]
nlohmann::ordered_json points_json(const Path& path);

/// Reads [[x_m, y_m], [x_m, y_m, yaw_deg], ...]. Throws InputError for anything else, for none and for more
/// than 100 of them.
std::vector<Goal> goals_from_json(const nlohmann::json& goals);

/// Reads [x_m, y_m, yaw_deg]. Throws InputError for anything else.
Pose2 pose_from_json(const nlohmann::json& pose);

}  // namespace lodestar
