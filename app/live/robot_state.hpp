#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/navigation/charging.hpp"
#include "app/navigation/mission.hpp"
#include "app/site/goal.hpp"
#include "drivers/base/base_driver.hpp"
#include "localization/integrity/marker_trust.hpp"
#include "maps/frame.hpp"
#include "maps/motion.hpp"

namespace lodestar {

/// Something that happened, in words for people.
struct DriveEvent {
  std::uint64_t number = 0;  ///< 1, 2, ... since the start
  Stamp stamp;
  std::string words;
};

/// How a drive ended that came with a ticket.
struct EndedDrive {
  std::uint64_t ticket = 0;
  bool arrived = false;
  std::string why;  ///< it did not arrive
};

/// Of an estimate.
struct TrueError {
  double position_m = 0.0;
  double heading_rad = 0.0;  ///< signed
};

/// The robot's state at one step: everything that the console shows.
struct RobotState {
  Stamp now;
  std::optional<PoseEstimate> estimate;
  std::optional<StopReason> stop;       ///< why it may not move, if so
  std::optional<StopReason> slowed_by;  ///< why the protective field allows less than is wanted
  BodyVelocity commanded;
  std::optional<BodyVelocity> measured;
  MissionPhase phase = MissionPhase::idle;
  std::vector<Goal> goals;  ///< of the present drive
  std::size_t current = 0;  ///< among them
  std::shared_ptr<const Path> path;
  BaseState base = BaseState::waiting_for_base;
  std::optional<BaseFault> fault;
  std::string fault_details;
  std::optional<double> battery_v;
  ChargingState charging = ChargingState::none;

  std::vector<int> markers;        ///< of the newest fix
  double confidence = 0.0;         ///< of its optimal marker
  std::optional<Stamp> last_seen;  ///< when that frame was taken
  std::vector<DistrustedMarker> distrusted;
  std::optional<Frame> frame;  ///< the newest

  std::shared_ptr<const SeenSurroundings> seen;  ///< by the scanner; null without one

  std::optional<TrueError> error;  ///< in simulation only
  std::vector<DriveEvent> events;  ///< the latest, oldest first
  std::vector<EndedDrive> ended;   ///< likewise
};

}  // namespace lodestar
