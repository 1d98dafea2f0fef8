#pragma once

#include <optional>
#include <vector>

#include "maps/motion.hpp"
#include "maps/occupancy_map.hpp"
#include "maps/percentile.hpp"

namespace lodestar {

struct TruePose {
  Stamp stamp;
  Pose2 map_from_base;
};

/// How one arrival really was.
struct ArrivalScore {
  double position_error_m = 0.0;
  std::optional<double> heading_error_rad;  ///< absolute; nothing when no heading was wanted
};

/// The judge of a simulated drive, the only one outside the simulated drivers who sees the truth. It never
/// answers while a decision could depend on it: the program asks after the drive, or hands in claims.
class Scorer {
 public:
  explicit Scorer(const OccupancyMap& map, double robot_radius_m);

  /// From the simulated world, at a fixed rate. `ran_against_obstacle`: since the record before, an obstacle
  /// held the robot where it was.
  void record(const TruePose& truth, bool ran_against_obstacle = false);

  /// What stands around is another one from now on.
  void change_map(const OccupancyMap& map) { map_ = map; }

  /// The navigator claims to have arrived. Scored by the newest record; ends the path followed.
  void claim_arrival(const Vec2& goal_m, std::optional<double> heading_rad);
  /// The navigator follows this path from now on; none, when it is empty.
  void claim_path(const Path& path);

  /// Another drive begins: forgets arrivals, contacts and all but the newest of the track.
  void forget();

  [[nodiscard]] const std::vector<ArrivalScore>& arrivals() const { return arrivals_; }
  [[nodiscard]] const std::vector<TruePose>& track() const { return track_; }
  /// Distances of the driven track from the path followed at the time, one per recorded pose at which the
  /// robot was on its way along a path: a robot that turns on the spot or waits adds none.
  [[nodiscard]] const std::vector<double>& path_distances_m() const { return path_distances_m_; }
  /// Recorded poses at which the robot's disc overlapped a cell that is not drivable, left the map, or had
  /// run against something.
  [[nodiscard]] int contacts() const { return contacts_; }

 private:
  [[nodiscard]] bool has_moved_to(const TruePose& truth) const;

  OccupancyMap map_;
  double robot_radius_m_ = 0.0;
  std::optional<Path> path_;
  std::vector<ArrivalScore> arrivals_;
  std::vector<TruePose> track_;
  std::vector<double> path_distances_m_;
  int contacts_ = 0;
};

}  // namespace lodestar
