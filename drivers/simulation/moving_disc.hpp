#pragma once

#include <cstddef>
#include <vector>

#include "maps/geometry.hpp"
#include "maps/stamp.hpp"

namespace lodestar {

/// Where a disc is at one time.
struct DiscKey {
  Duration time{};  ///< since the start of the simulation
  Vec2 position_m = Vec2::Zero();
};

/// The way of a disc over time: straight and at constant speed from key to key. Before the first key it
/// stands there, after the last it stands there too, or with `loops` begins again at the first.
struct DiscTrajectory {
  std::vector<DiscKey> keys;  ///< at least one, times ascending
  bool loops = false;
};

/// A person or a thing that moves and that no map has, as a disc on the floor.
struct MovingDisc {
  double radius_m = 0.25;
  bool has_legs = false;  ///< a scanner sees only two swinging legs below it
  DiscTrajectory trajectory;
};

/// A disc at one moment.
struct DiscState {
  double radius_m = 0.25;
  bool has_legs = false;
  Vec2 position_m = Vec2::Zero();
  Vec2 velocity_mps = Vec2::Zero();
  double heading_rad = 0.0;  ///< of the latest motion
  double walked_m = 0.0;     ///< since the start; the legs swing with it
};

/// A disc on its trajectory, asked at ascending times.
class FollowedTrajectory {
 public:
  explicit FollowedTrajectory(MovingDisc disc);

  /// Where it is at that time.
  [[nodiscard]] DiscState at(Stamp now);

 private:
  [[nodiscard]] Duration time_in_keys(Stamp now) const;

  MovingDisc disc_;
  std::size_t next_ = 0;  ///< the first key after the latest time
  DiscState state_;
  bool has_begun_ = false;
};

/// What a scanner sees of a disc: the disc, or its two legs.
struct VisibleDisc {
  Vec2 center_m = Vec2::Zero();
  Vec2 velocity_mps = Vec2::Zero();
  double radius_m = 0.0;
};

/// Appends what a scanner sees of a disc.
void append_visible(const DiscState& disc, std::vector<VisibleDisc>& visible);

}  // namespace lodestar
