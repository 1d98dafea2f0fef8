#pragma once

#include <optional>
#include <vector>

#include "app/live/robot_state.hpp"
#include "app/recording/drive_moment.hpp"
#include "app/report/run_record.hpp"
#include "app/site/site.hpp"
#include "app/viewers/channel.hpp"
#include "app/viewers/foxglove_messages.hpp"

namespace lodestar {

/// The channels of a drive:
///
///   /tf, /tf_static   base_link in map by the estimate; camera in base_link
///   /map, /markers    occupancy grid and marker registry; a distrusted marker turns red
///   /path             planned
///   /robot, /pose     footprint and uncertainty ellipse; the estimate
///   /drive, /fix      numbers for plots: velocities, deviations, state; every pose fix
///   /log              events, in words
///   /camera           pictures and calibration
///   /scan, /obstacles where the beams end and what is known of each; the memory of what the map lacks
///   /truth, /error    in simulation: the true pose, and the error of the estimate
const std::vector<Channel>& drive_channels();

/// Index of /camera among them: pictures are the most expensive, so they are encoded only for subscribers.
extern const std::size_t camera_channel;

/// The state of a drive at an estimate.
struct EstimateMoment {
  const PoseEstimate& estimate;
  BodyVelocity commanded;
  std::optional<BodyVelocity> measured;
  BaseState base = BaseState::waiting_for_base;
  std::optional<BaseFault> fault;
  std::optional<StopReason> stop;
  std::optional<StopReason> slowed_by;  ///< by the protective field
};

RobotBody body_of(const Robot& robot);

/// Everything that does not change during a drive.
std::vector<Message> scene_messages(const KnownWorld& world, Stamp stamp);
/// /tf, /pose, /robot and /drive.
std::vector<Message> estimate_messages(const EstimateMoment& moment, const RobotBody& body);
Message planned_message(Stamp stamp, const Path& planned);
Message ceiling_message(Stamp stamp, const MarkerRegistry& registry, const std::vector<int>& distrusted);
Message words_message(Stamp stamp, LogLevel level, const std::string& words);
/// `jpeg`: the picture, encoded.
Message camera_message(Stamp stamp, const std::string& jpeg);
/// /scan and /obstacles.
std::vector<Message> seen_messages(Stamp stamp, const SeenSurroundings& seen);
/// /error.
Message error_message(const PoseEstimate& estimate, const TrueError& off);

/// Ground truth of a simulated drive, after the drive.
std::vector<Message> truth_messages(const RunRecord& record);

std::vector<int> ids_of(const std::vector<DistrustedMarker>& distrusted);

/// Converts a drive to messages, step by step.
class DriveMessages {
 public:
  DriveMessages(const KnownWorld& world, RobotBody body);

  /// The messages of this step without its picture; at the first step also everything that does not change.
  std::vector<Message> of(const DriveMoment& moment);

 private:
  void say_estimate(const DriveMoment& moment, std::vector<Message>& messages);
  void say_seen(const DriveMoment& moment, std::vector<Message>& messages);
  void say_distrust(const DriveMoment& moment, std::vector<Message>& messages);
  void say_base(const DriveMoment& moment, std::vector<Message>& messages);

  KnownWorld world_;
  RobotBody body_;
  bool has_begun_ = false;
  std::optional<Stamp> last_pose_;
  std::optional<Stamp> last_scan_;
  std::string base_said_;
  std::vector<int> distrusted_;
};

}  // namespace lodestar
