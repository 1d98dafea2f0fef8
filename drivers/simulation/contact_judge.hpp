#pragma once

#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "drivers/simulation/moving_disc.hpp"
#include "drivers/simulation/robot_clearance.hpp"
#include "maps/occupancy_map.hpp"

namespace lodestar {

/// What the robot declares, and what it promises: no contact while it moves. A contact is excused only where
/// that promise does not reach.
struct ContactJudgeOptions {
  // An ideal scanner on the robot; of people it sees the legs.
  Pose2 base_from_scanner;
  double range_m = 12.0;
  Duration scan_period = std::chrono::milliseconds(100);
  Duration scan_delay = std::chrono::milliseconds(30);     ///< from the end of a turn to delivery
  Duration reaction = std::chrono::milliseconds(60);       ///< from delivery to a zero command on the bus
  double protective_deceleration_mps2 = 1.5;               ///< of robot.yaml
  double fast_mps = 2.0;                                   ///< people who are faster are excused ...
  Duration fast_within = std::chrono::milliseconds(1200);  ///< ... so long before the contact
};

/// Contacts with discs, each counted once from touch to release.
struct ContactScore {
  int moving = 0;                           ///< while the robot moved, not excused
  int excused = 0;                          ///< while it moved
  int at_rest = 0;                          ///< it stood
  double greatest_contact_mps = 0.0;        ///< the robot's fastest in any contact, excused or not
  std::optional<double> least_clearance_m;  ///< edge to edge, to discs and to the map; negative: overlap
};

/// Judges contacts between the robot and discs by the truth.
class ContactJudge {
 public:
  ContactJudge(const OccupancyMap& map, double robot_radius_m, const std::optional<Footprint>& footprint,
               const ContactJudgeOptions& options);

  /// Call at a steady rate, every 10 ms or so, always with the same discs.
  void record(Stamp now, const Pose2& map_from_base, std::span<const DiscState> discs);

  void change_map(const OccupancyMap& map);
  /// Counts from here on.
  void forget() { score_ = {}; }
  [[nodiscard]] const ContactScore& score() const { return score_; }
  /// The faster of the robot's origin and of the farthest point of its edge about it, at the last record.
  [[nodiscard]] double speed_mps() const { return history_.empty() ? 0.0 : history_.back().speed_mps; }

 private:
  enum class Touch { none, at_rest, moving };
  struct Moment {
    Stamp stamp;
    Pose2 map_from_base;
    double speed_mps = 0.0;
    std::vector<DiscState> discs;
  };

  [[nodiscard]] bool is_carried_off(Stamp now, const Pose2& map_from_base) const;
  void remember(Stamp now, const Pose2& map_from_base, std::span<const DiscState> discs);
  void measure_room(std::span<const DiscState> discs);
  void judge(std::size_t disc, const DiscState& state);
  [[nodiscard]] bool is_excused(std::size_t disc) const;
  [[nodiscard]] bool was_fast(std::size_t disc) const;
  [[nodiscard]] bool came_into_sight_too_late(std::size_t disc) const;
  [[nodiscard]] bool sees(const Moment& moment, const VisibleDisc& disc) const;

  OccupancyMap map_;
  double robot_radius_m_;
  std::optional<Footprint> footprint_;
  RobotClearance clearance_;
  ContactJudgeOptions options_;
  std::deque<Moment> history_;
  bool has_forgotten_ = false;  ///< the history no longer reaches back to the start
  std::vector<Touch> touches_;
  double room_on_map_m_ = 0.0;  ///< at least so much is left, by what was measured last and moved since
  ContactScore score_;
};

}  // namespace lodestar
