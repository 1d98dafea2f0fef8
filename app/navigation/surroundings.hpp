#pragma once

#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "app/navigation/holding_points.hpp"
#include "app/navigation/lingering_people.hpp"
#include "app/navigation/seen_surroundings.hpp"
#include "app/navigation/unmapped_obstacles.hpp"
#include "app/site/goal.hpp"
#include "control/field_release.hpp"
#include "control/hidden_corners.hpp"
#include "control/protective_field.hpp"
#include "control/safety_stop.hpp"
#include "localization/integrity/map_contradiction.hpp"
#include "localization/integrity/scanner_watch.hpp"
#include "localization/scan/deskewed.hpp"
#include "localization/scan/height_slab.hpp"
#include "maps/map_overlay.hpp"
#include "maps/obstacle_memory.hpp"

namespace lodestar {

/// A depth camera beside the scanner.
struct DepthSourceOptions {
  DepthMount mount;
  HeightSlabOptions slab;
  /// Without an image for so long the robot stands: several images of the slowest camera (6 Hz).
  Duration max_silence = std::chrono::milliseconds(700);
  /// Images that follow sooner are passed over: each costs some milliseconds, and scanners are no faster.
  Duration least_period = std::chrono::milliseconds(90);
};

/// How far paths keep from what is not on the map, beyond what was hit.
struct RoomAround {
  double things_m = 0.0;
  double legs_m = 0.0;       ///< the body that they carry
  double posts_m = 0.0;      ///< the seat or table top that they may carry
  double lingering_m = 0.0;  ///< people who linger; paths lead up to them where it is 0
  double waiting_m = 0.0;    ///< who has come, may go and holds the robot; likewise
};

/// What a robot with a scanner is, and how it minds what the scanner sees.
struct SurroundingsOptions {
  ScannerMount mount;
  RobotShape shape{0.25};
  WheelTrackOptions wheels;
  ObstacleMemoryOptions memory;
  ProtectiveFieldOptions field;
  FieldReleaseOptions release;
  HiddenCornerOptions corners;
  std::optional<DepthSourceOptions> depth;
  ScannerWatchOptions watch;
  MapContradictionOptions contradiction;
  HoldingPointsOptions holding;
  /// A path is looked at no more often than this for what stands in its way.
  Duration between_detours = std::chrono::seconds(1);
  /// More than the field needs: what is behind the side that was seen is not known, and cells of 5 cm round
  /// it off. Beside who lingers it stops the robot at 1.05 m, also in a turn, towards them at 1.35 m; before
  /// who may go at 0.57 m.
  RoomAround roomy{.things_m = 0.04, .legs_m = 0.28, .posts_m = 0.28, .lingering_m = 1.3, .waiting_m = 0.6};
  /// Where there is no way with so much room: as much as the field lets pass
  /// (ProtectiveFieldOptions::body_m).
  RoomAround tight{.things_m = 0.0, .legs_m = 0.20, .posts_m = 0.0, .lingering_m = 0.0, .waiting_m = 0.0};
  /// With so much a path that is followed can be followed on: `tight` from things and legs, `roomy` from
  /// people.
  RoomAround passable{.things_m = 0.0, .legs_m = 0.20, .posts_m = 0.0, .lingering_m = 1.3, .waiting_m = 0.6};
  LingeringPeopleOptions lingering;
  double leaves_m = 0.2;  ///< beside the robot, so that a path need not begin with a step back from someone
  /// What is nearer to the robot than this counts for a path by its hits alone, so that one can begin there.
  double begins_beside_m = 0.06;
  /// What stands so near to a path's disc is in its way, unless the path leads away from it: what a path
  /// keeps at the least.
  double least_margin_m = 0.01;
};

/// The map that the robot knows and, while nothing speaks against it, its pose there.
struct MappedPose {
  const ObstacleField& map;
  std::optional<PoseEstimate> estimate;
};

/// What is around the robot by its scanner and wheels, in the odometry frame: what may be sent of a velocity,
/// and what stands in the way. The map only explains: what it has does not move. Without a pose everything
/// may.
class Surroundings {
 public:
  explicit Surroundings(const SurroundingsOptions& options);

  /// Wheel travel first, then the scans and depth images that arrived with it.
  void add(std::span<const WheelTravel> travel, std::span<const Scan> scans,
           std::span<const DepthImage> depths, Stamp now, const MappedPose& mapped);

  /// The wheels' scales as learned so far.
  void use_scales(const TravelScales& scales) { track_.use_scales(scales); }

  /// What the scanner's driver has read and refused, since the beginning.
  void add_packets(const ScanPackets& total, Stamp now) { watch_.add_packets(total, now); }

  /// Why the scanner, or the map held against it, forbids to move.
  [[nodiscard]] std::optional<StopReason> reason_to_stop(Stamp now) const;

  struct Allowed {
    BodyVelocity velocity;
    std::optional<StopReason> reason;     ///< why the robot must stand, where it wants to move
    std::optional<StopReason> slowed_by;  ///< why it may not move as fast as it wants to
  };
  /// What may be sent of the wanted velocity; once a control step.
  Allowed allowed(Stamp now, const std::optional<BodyVelocity>& measured, const BodyVelocity& wanted);

  /// What stands around the robot that the map lacks, or has held it all the same, with room for paths to the
  /// goals.
  [[nodiscard]] UnmappedObstacles unmapped(Stamp now, const MappedPose& mapped,
                                           std::span<const Goal> goals) const;

  /// The same where a path that begins at the robot has not all the room that is planned with, at most once a
  /// second; nothing where the way is clear.
  std::optional<UnmappedObstacles> obstacles_in_the_way(Stamp now, const MappedPose& mapped, const Path& path,
                                                        std::span<const Goal> goals);

  /// What the scanner shows, for people to look at; nothing before the first scan.
  [[nodiscard]] std::optional<SeenSurroundings> seen(Stamp now, const MappedPose& mapped) const;

  /// After the robot has been told where it stands.
  void pose_was_set() { contradiction_.reset(); }

 private:
  bool take(const Scan& scan, const MappedPose& mapped);
  bool take(const DepthImage& image, const MappedPose& mapped);
  [[nodiscard]] std::optional<Pose2> map_from_odom(const MappedPose& mapped) const;
  void hold_against_map(const Scan& scan, std::span<const Pose2> odom_from_base, const Pose2& map_from_odom,
                        const MappedPose& mapped);
  [[nodiscard]] bool is_within_robot(const Ray& ray) const;
  [[nodiscard]] std::vector<FieldPoint> presences(const DeskewedScan& scan, const ObstacleMemory& memory,
                                                  const std::optional<Pose2>& map_from_odom,
                                                  const MappedPose& mapped) const;
  [[nodiscard]] std::vector<FieldPoint> corners_of(const DeskewedScan& scan,
                                                   const std::optional<Pose2>& map_from_odom,
                                                   const MappedPose& mapped) const;
  [[nodiscard]] std::vector<const ObstacleMemory*> memories() const;
  [[nodiscard]] std::vector<Vec2> unmapped_m(Stamp now, const MappedPose& mapped, std::span<const Goal> goals,
                                             const RoomAround& room) const;
  void hold(Stamp now, const std::optional<Pose2>& odom_from_base, const FieldLimit& limit,
            const BodyVelocity& allowed);

  SurroundingsOptions options_;
  OwnOutline outline_;
  OwnParts own_parts_;
  ProtectiveField field_;
  WheelTrack track_;
  ScannerWatch watch_;
  MapContradiction contradiction_;
  ObstacleMemory memory_;
  LingeringPeople lingering_;
  /// What is above the scan plane, which a scanner's beams pass below and must not clear.
  struct Above {
    HeightSlab slab;
    ObstacleMemory memory;
    std::deque<DepthImage> waiting;  ///< for the wheel readings of their time
    std::optional<Stamp> newest;
    cv::Mat last_mm;
    std::vector<FieldPoint> points;
  };
  std::optional<Above> above_;
  FieldRelease release_;
  HoldingPoints holding_;
  std::deque<Scan> waiting_;             ///< for the wheel readings of their time
  std::optional<FieldScan> field_scan_;  ///< of all sources; its age is the newest scan's
  std::size_t scanned_points_ = 0;    ///< the first of its points; those of the depth camera come after them
  std::optional<Stamp> looked_at_;    ///< the newest scan when things in the way were last looked for
  std::optional<Stamp> last_detour_;  ///< when a path was blocked last
};

}  // namespace lodestar
