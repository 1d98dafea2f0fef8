#pragma once

#include <optional>
#include <span>
#include <vector>

#include "drivers/simulation/moving_disc.hpp"
#include "maps/geometry.hpp"
#include "maps/stamp.hpp"

namespace lodestar {

/// An automatic sliding door that no map has, and when it is to be shut.
struct SlidingDoor {
  Vec2 from_m = Vec2::Zero();  ///< on the map, at the post in whose wall it waits
  Vec2 to_m = Vec2::Zero();    ///< at the other post
  Duration shuts{};            ///< since the start of the simulation
  std::optional<Duration> opens;
};

/// The leaf of a door, as a row of small discs. It starts from rest and comes to rest at its ends. While
/// someone is near the doorway it does not shut, and opens where it is shutting, as the presence sensor of a
/// powered door makes it (EN 16005); a shut one stays shut.
class SlidingLeaf {
 public:
  explicit SlidingLeaf(const SlidingDoor& door);

  /// Moves on to that time; `present_m` are the robot and all people.
  void step(Stamp now, Duration by, std::span<const Vec2> present_m);

  /// Where its discs are; always the same number.
  [[nodiscard]] const std::vector<DiscState>& discs() const { return discs_; }

 private:
  [[nodiscard]] bool is_wanted_shut(Stamp now, std::span<const Vec2> present_m) const;
  void place_discs();

  SlidingDoor door_;
  double width_m_ = 0.0;
  double out_m_ = 0.0;  ///< of the wall, up to the width
  double speed_mps_ = 0.0;
  std::vector<DiscState> discs_;
};

}  // namespace lodestar
