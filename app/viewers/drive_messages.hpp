#pragma once

#include <optional>
#include <vector>

#include "app/recording/drive_moment.hpp"
#include "app/report/run_record.hpp"
#include "app/site/site.hpp"
#include "app/viewers/channel.hpp"
#include "app/viewers/foxglove_messages.hpp"

namespace lodestar {

/// The channels of a drive:
///
///   /tf, /tf_static   base_link in map by the estimate; camera in base_link
///   /map, /markers    the floor and the ceiling as known; a marker no longer trusted turns red
///   /path             planned
///   /robot, /pose     footprint and the ellipse of its uncertainty; the estimate
///   /drive, /fix      numbers for plots: velocities, deviations, state; every pose that came of a frame
///   /log              what happens, in words
///   /camera           pictures and calibration
///   /truth, /error    in simulation: where the robot really was, and how far the estimate was off
const std::vector<Channel>& drive_channels();

/// The place of /camera among them: pictures cost more than all else, so it is asked first who wants them.
extern const std::size_t camera_channel;

/// What is known of the drive together with an estimate.
struct EstimateMoment {
  const PoseEstimate& estimate;
  BodyVelocity commanded;
  std::optional<BodyVelocity> measured;
  BaseState base = BaseState::waiting_for_base;
  std::optional<BaseFault> fault;
  std::optional<StopReason> stop;
};

RobotBody body_of(const Robot& robot);

/// All that does not change during a drive.
std::vector<Message> scene_messages(const KnownWorld& world, Stamp stamp);
/// /tf, /pose, /robot and /drive.
std::vector<Message> estimate_messages(const EstimateMoment& moment, const RobotBody& body);
Message planned_message(Stamp stamp, const Path& planned);
Message ceiling_message(Stamp stamp, const MarkerRegistry& registry, const std::vector<int>& distrusted);
Message words_message(Stamp stamp, LogLevel level, const std::string& words);
/// `jpeg`: the picture, encoded.
Message camera_message(Stamp stamp, const std::string& jpeg);
/// How far the estimate is off in place; the heading's error is not known.
Message error_message(const PoseEstimate& estimate, double error_m);

/// What only the judge of a simulated drive knows, after the drive.
std::vector<Message> truth_messages(const RunRecord& record);

std::vector<int> ids_of(const std::vector<DistrustedMarker>& distrusted);

/// Puts a drive into messages, moment by moment.
class DriveMessages {
 public:
  DriveMessages(const KnownWorld& world, RobotBody body);

  /// What there is to say of this moment but for its picture; of the first one also all that does not change.
  std::vector<Message> of(const DriveMoment& moment);

 private:
  void say_estimate(const DriveMoment& moment, std::vector<Message>& messages);
  void say_distrust(const DriveMoment& moment, std::vector<Message>& messages);
  void say_base(const DriveMoment& moment, std::vector<Message>& messages);

  KnownWorld world_;
  RobotBody body_;
  bool has_begun_ = false;
  std::optional<Stamp> last_pose_;
  std::string base_said_;
  std::vector<int> distrusted_;
};

}  // namespace lodestar
