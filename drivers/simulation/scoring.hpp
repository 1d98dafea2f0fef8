#pragma once

#include <optional>
#include <span>
#include <vector>

#include "drivers/simulation/contact_judge.hpp"
#include "maps/footprint.hpp"
#include "maps/motion.hpp"
#include "maps/occupancy_map.hpp"
#include "maps/percentile.hpp"

namespace lodestar {

struct TruePose {
  Stamp stamp;
  Pose2 map_from_base;
};

/// The true errors of one arrival.
struct ArrivalScore {
  double position_error_m = 0.0;
  std::optional<double> heading_error_rad;  ///< absolute; empty when no heading was requested
};

/// Scores a simulated drive against ground truth; the only class outside the simulated drivers that knows it.
/// No decision can depend on it: results are read after the drive, and during it the program only reports
/// claims.
class Scorer {
 public:
  /// The robot is a disc, or the footprint if there is one.
  Scorer(const OccupancyMap& map, double robot_radius_m, std::optional<Footprint> footprint = {},
         const ContactJudgeOptions& contacts = {});

  /// Called by the simulated world at a fixed rate. `ran_against_obstacle`: since the previous record, an
  /// obstacle blocked the robot.
  void record(const TruePose& truth, bool ran_against_obstacle = false);

  /// Called by a simulated world that has discs or a scanner at a fixed rate of its own.
  void record_discs(const TruePose& truth, std::span<const DiscState> discs);

  /// Replaces the map of obstacles.
  void change_map(const OccupancyMap& map);

  /// The navigator claims to have arrived: scored against the newest record; ends the path followed.
  void claim_arrival(const Vec2& goal_m, std::optional<double> heading_rad);
  /// Sets the path that the navigator follows; empty: none.
  void claim_path(const Path& path);

  /// Starts another drive: clears arrivals, contacts and all of the track but its newest pose.
  void forget();

  [[nodiscard]] const std::vector<ArrivalScore>& arrivals() const { return arrivals_; }
  [[nodiscard]] const std::vector<TruePose>& track() const { return track_; }
  /// Cross-track errors: distances of the driven track from the path followed at the time, one per recorded
  /// pose at which the robot moved along a path; turning on the spot and waiting add none.
  [[nodiscard]] const std::vector<double>& path_distances_m() const { return path_distances_m_; }
  /// How often the robot began to overlap a cell that is not drivable, to be outside the map, or to be
  /// blocked by an obstacle: each once from touch to release, in the drive in which it began.
  [[nodiscard]] int contacts() const { return contacts_; }
  /// The contacts with discs, and those with the map among the moving ones, each counted once from touch to
  /// release. Without discs and scanner in the world: those with the map alone, and no clearance.
  [[nodiscard]] ContactScore contact_score() const;

 private:
  /// Of the origin, since the newest record.
  [[nodiscard]] double speed_to_mps(const TruePose& truth) const;
  [[nodiscard]] bool has_moved_to(const TruePose& truth) const;

  OccupancyMap map_;
  double robot_radius_m_ = 0.0;
  std::optional<Footprint> footprint_;
  std::optional<Path> path_;
  std::vector<ArrivalScore> arrivals_;
  std::vector<TruePose> track_;
  std::vector<double> path_distances_m_;
  ContactJudge judge_;
  double latest_speed_mps_ = 0.0;
  bool touches_map_ = false;
  int contacts_ = 0;
  double greatest_map_contact_mps_ = 0.0;
};

}  // namespace lodestar
