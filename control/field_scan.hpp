#pragma once

#include <cstdint>
#include <vector>

#include "maps/geometry.hpp"
#include "maps/stamp.hpp"

namespace lodestar {

/// What is known of a point that the scanner hits.
enum class Presence : std::uint8_t {
  mapped,    ///< the map explains it: it does not move
  standing,  ///< not on the map, but it has stood for a second
  legs,      ///< the same, but of someone who has legs, or of a chair: what they carry reaches farther out
  waiting,   ///< someone who was seen to come there, and may go at any time
  person,    ///< anything else
  hidden     ///< nothing was hit here, but someone may be behind
};

/// What does not move now, though some of it may begin to.
inline bool is_still(Presence presence) {
  return presence == Presence::mapped || presence == Presence::standing || presence == Presence::legs;
}

struct FieldPoint {
  Stamp stamp;
  Vec2 point_in_odom = Vec2::Zero();
  Presence presence = Presence::person;
  bool stays = false;  ///< has been about this place for a while, and may be for longer
};

/// A scan prepared for the protective field, once for all control steps until the next one.
struct FieldScan {
  Stamp newest;  ///< of the beam measured last
  std::vector<FieldPoint> points;
};

/// A point beside the robot as of now.
struct FieldHit {
  Vec2 point_in_base = Vec2::Zero();
  double age_s = 0.0;  ///< since it was seen there
  Presence presence = Presence::person;
  bool stays = false;  ///< as of the point
};

/// From where the robot is now; without points farther than `within_m` from the base frame's origin.
std::vector<FieldHit> seen_from(const Pose2& odom_from_base, Stamp now, const FieldScan& scan,
                                double within_m);

}  // namespace lodestar
