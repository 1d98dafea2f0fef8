#pragma once

#include <cstdint>
#include <future>
#include <optional>
#include <string>
#include <vector>

#include "app/navigation/learned_state.hpp"
#include "app/site/goal.hpp"
#include "localization/integrity/marker_trust.hpp"
#include "maps/marker_registry.hpp"
#include "maps/motion.hpp"
#include "maps/occupancy_map.hpp"

// The record of one drive in memory, as far as the robot itself can know it; report/ adds what the judge
// says.
namespace lodestar {

/// One step of the navigator, at its steady rate.
struct StepRecord {
  PoseEstimate estimate;
  BodyVelocity commanded;
  BodyVelocity measured;             ///< by the base
  Vec2 wheel_scales = Vec2::Ones();  ///< true over reported travel, left and right, as estimated so far
};

/// One frame that gave a pose.
struct FixRecord {
  Stamp stamp;  ///< capture
  Pose2 map_from_base;
  std::vector<int> ids;
  double confidence = 0.0;
  bool accepted = false;  ///< by the pose filter
};

/// A camera frame kept in the record.
struct KeptPicture {
  Stamp stamp;  ///< capture
  std::shared_future<std::string>
      jpeg;  ///< encoded in the background, see PictureKeeper; empty when that failed
};

/// How one goal ended.
struct GoalRecord {
  Goal goal;
  Path planned;
  bool arrived = false;
  std::string failure;     ///< in words, when it did not arrive
  double ideal_s = 0.0;    ///< ideal travel time of the path planned first
  Duration travel_time{};  ///< simulated
  Stamp ended;             ///< when the goal was reached or given up
};

/// From this stamp on the navigator reported this problem, or none any more.
struct NoticeRecord {
  Stamp stamp;
  std::string words;  ///< empty: all is well again
  bool stops = false;
};

struct DriveRecord {
  std::string site;
  std::string camera;  ///< profile: wide or paper
  std::uint64_t seed = 0;
  std::string repeat;  ///< the command that reproduces the run
  Pose2 start;
  double robot_radius_m = 0.0;
  std::vector<GoalRecord> goals;
  std::vector<StepRecord> steps;
  std::vector<FixRecord> fixes;
  std::vector<KeptPicture> pictures;         ///< a few a second, where wanted
  int dropped_pictures = 0;                  ///< that were due and found no room, see PictureKeeper
  std::vector<DistrustedMarker> distrusted;  ///< at the end
  std::optional<LearnedState> learned;       ///< at the end; nothing when the pose was unknown
  std::vector<NoticeRecord> notices;
  int frames = 0;            ///< that arrived from the camera
  double wall_time_s = 0.0;  ///< never written to a file that must repeat byte for byte

  [[nodiscard]] bool arrived() const;
};

}  // namespace lodestar
