#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "drivers/simulation/moving_disc.hpp"
#include "maps/distance_field.hpp"
#include "maps/occupancy_map.hpp"
#include "maps/random.hpp"

namespace lodestar {

/// How a person behaves towards the robot.
enum class PersonKind {
  ordinary,    ///< keeps off as from another person
  oblivious,   ///< does not see it
  threatening  ///< waits, also behind a corner, and steps in its way when it comes
};

struct PeopleOptions {
  int count = 0;
  // Shares of the kinds; the rest is ordinary.
  double oblivious_share = 0.3;
  double threatening_share = 0.2;
  double group_share = 0.2;  ///< walk beside the person before them
  double radius_m = 0.25;
  bool have_legs = true;
  /// Walking speed wanted. Recorded walkers: median 1.47, 95 % below 1.99 m/s; they are drawn from that and
  /// capped at what the robot plans with.
  double median_mps = 1.4;
  double sigma_mps = 0.3;
  double slowest_mps = 0.5;
  double fastest_mps = 2.0;
  double max_acceleration_mps2 = 3.0;  ///< from rest to a walk within half a second
  /// The robot, which nobody walks through: who does not see it runs against it, and gives way a little.
  double robot_radius_m = 0.0;
  double gives_way_m = 0.02;
};

/// A person, as the social forces act on them.
struct Walker {
  PersonKind kind = PersonKind::ordinary;
  double wanted_mps = 1.4;
  Vec2 goal_m = Vec2::Zero();
  Duration goal_time{};  ///< left for it
  Duration held_up{};    ///< has got no further for so long
  bool waits = false;    ///< a threatening one, until the robot comes
  std::optional<std::size_t> leader;
  DiscState disc;
};

/// The force (per mass, m/s^2) of another on a walker: Moussaid et al., "Experimental study of the
/// behavioural mechanisms underlying self-organization in human crowds", 2009, with its parameters.
Vec2 social_force_mps2(const Vec2& position_m, const Vec2& velocity_mps, const Vec2& other_m,
                       const Vec2& other_velocity_mps);

/// The force towards the goal (Helbing and Molnar, "Social force model for pedestrian dynamics", 1995).
Vec2 goal_force_mps2(const Walker& walker);

/// People who walk about in a building. The same seed and the same robot give the same people.
class Walkers {
 public:
  /// They begin at random free places, at least 2 m from the robot.
  Walkers(const OccupancyMap& map, const PeopleOptions& options, const Pose2& map_from_base,
          std::uint64_t seed);

  /// `things` are discs that move by themselves, such as boxes that are pushed: people go around these, and
  /// walk through none, nor through the robot.
  void step(Duration by, const Pose2& map_from_base, std::span<const DiscState> things = {});

  [[nodiscard]] const std::vector<Walker>& walkers() const { return walkers_; }

 private:
  struct Robot {
    Vec2 position_m;
    Vec2 velocity_mps;
    double yaw_rad = 0.0;
  };

  [[nodiscard]] bool is_free(const Vec2& place_m) const;
  [[nodiscard]] std::optional<Vec2> random_place();
  void choose_goal(Walker& walker);
  void notice(Walker& walker, const Robot& robot);
  [[nodiscard]] Vec2 wall_force_mps2(const Vec2& position_m) const;
  [[nodiscard]] Vec2 force_mps2(std::size_t walker, const Robot& robot,
                                std::span<const DiscState> things) const;
  [[nodiscard]] bool is_passable(const DiscState& self, const Vec2& place_m,
                                 std::span<const DiscState> solids) const;
  void move(Walker& walker, const Vec2& force_mps2, double by_s, std::span<const DiscState> solids) const;

  OccupancyMap map_;
  DistanceField field_;
  PeopleOptions options_;
  Random random_;
  std::optional<Pose2> last_robot_;
  std::vector<Walker> walkers_;
};

}  // namespace lodestar
