#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "control/braking_path.hpp"
#include "control/field_options.hpp"
#include "control/field_scan.hpp"
#include "maps/motion.hpp"
#include "maps/robot_shape.hpp"

namespace lodestar {

enum class FieldReason {
  person_near,     ///< someone could be here before the robot is at rest
  obstacle_ahead,  ///< the robot would touch what stands there, on the map or not
  hidden_corner,   ///< someone may be behind it
  no_scan          ///< what is around the robot is not known
};
std::string_view to_string(FieldReason reason);

struct FieldLimit {
  double share = 1.0;                 ///< of the velocity wanted, 0 to 1
  std::optional<FieldReason> reason;  ///< nothing: the field does not limit
  std::optional<FieldHit> nearest;    ///< what limits the most
};

/// How much of a velocity is safe: the robot, braking with what it has, is at rest before anyone can touch it
/// (passive safety; no braking inevitable collision state: Bouraine, Fraichard and Salhi 2012; Mitsch,
/// Ghorbal, Vogelbacher and Platzer 2017). By the scan and the wheels alone, without map or pose. It only
/// ever lowers a command.
class ProtectiveField {
 public:
  explicit ProtectiveField(RobotShape shape, const ProtectiveFieldOptions& options = {});

  /// The greatest share of the wanted velocity (the curve's radius is kept) for which, all along the way to
  /// rest, the outline is farther from each hit than what is there may have come. What stands nearer than its
  /// margin does not hold a robot that moves away from it.
  [[nodiscard]] FieldLimit limit(std::span<const FieldHit> hits, const BodyVelocity& measured,
                                 const BodyVelocity& wanted) const;

  /// The same by the newest scan, from where the robot is now. Without one newer than max_scan_age: zero.
  [[nodiscard]] FieldLimit limit(const std::optional<FieldScan>& scan, Stamp now, const Pose2& odom_from_base,
                                 const BodyVelocity& measured, const BodyVelocity& wanted) const;

  [[nodiscard]] const RobotShape& shape() const { return shape_; }
  [[nodiscard]] const ProtectiveFieldOptions& options() const { return options_; }

 private:
  /// How far what is there may have come since it was seen.
  [[nodiscard]] double reach_m(Presence presence, double time_s) const;
  [[nodiscard]] double margin_m(Presence presence) const;
  [[nodiscard]] double turning_away_s(const BrakingPath& path, const FieldHit& hit) const;
  [[nodiscard]] double least_share(const FieldHit& hit, const BodyVelocity& wanted) const;
  [[nodiscard]] bool is_safe(const BrakingPath& path, const FieldHit& hit, double distance_m,
                             double least_room_m) const;
  [[nodiscard]] bool stays_clear(const BrakingPath& path, const FieldHit& hit, double room_m) const;
  [[nodiscard]] double drift_beside_m(const FieldHit& hit) const;
  [[nodiscard]] bool rests_in_time(const BrakingPath& path, const FieldHit& hit, double after_s) const;
  [[nodiscard]] double within_m(const BodyVelocity& measured, const BodyVelocity& wanted) const;

  RobotShape shape_;
  ProtectiveFieldOptions options_;
};

}  // namespace lodestar
