#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "localization/integrity/scanner_mount_watch.hpp"
#include "maps/motion.hpp"
#include "maps/scan.hpp"

namespace lodestar {

/// Scanner faults.
enum class ScannerFault {
  silent,       ///< no scan has come
  other_clock,  ///< stamped in the future, far in the past, or out of order
  late,         ///< scans arrive long after they were measured
  frozen,       ///< the same ranges again
  checksums,    ///< the driver refuses much of what arrives
  motor,        ///< turns too slowly or too fast
  dirty,        ///< a sector of the window is blind, wherever the robot turns
  beams_lost,   ///< many beams bring nothing back that can be used
  turned,       ///< the mount is turned against the map
};

// Message for the operator.
std::string_view to_string(ScannerFault fault);

/// What is noticed, when, at 10 scans a second:
///
///     silent       0.3 s after the last scan
///     other_clock  with the first scan that is stamped so
///     late         with the first scan that comes so
///     frozen       with the second repeated scan, once the robot has moved 2 cm or turned 1 degree since the
///                  first; at rest too, where the scanner has shown noise while the robot stood, or has never
///                  changed and is less than 10 s old
///     checksums    within 2 s
///     motor        with the fifth scan, where it is off by more than 20 %
///     dirty        once the robot has turned 90 degrees and driven 1 m since the window became dirty
///     beams_lost   after 1 s; after 0.3 s where hardly a beam is left
///     turned       see ScannerMountWatch
struct ScannerWatchOptions {
  Duration max_silence = std::chrono::milliseconds(300);  ///< three scans at 10 Hz
  /// Of the newest beam on arrival: one turn at 10 Hz that a capsule protocol holds back, and 50 ms on the
  /// way.
  Duration max_age = std::chrono::milliseconds(150);
  Duration max_ahead = std::chrono::milliseconds(20);  ///< as of a camera: one step of the navigation
  Duration another_age = std::chrono::seconds(5);      ///< older is from another clock
  /// Scans may overlap so far, by what a device's clock is adjusted.
  Duration max_overlap = std::chrono::milliseconds(10);
  double track_width_m = 0.4;
  double moved_m = 0.02;  ///< ranges to things at hand change by more than the step of any scanner
  double turned_rad = radians(1.0);
  std::size_t least_hits = 20;  ///< to tell one scan from another
  /// A scanner whose scans have all been the same is not known to be alive, and counts as frozen for so long.
  /// One without noise then shows it as the robot moves.
  Duration unproven_for = std::chrono::seconds(10);
  /// Share of beams that differ between two scans at rest, from which a scanner has noise.
  double noisy_share = 0.5;
  double max_refused_share = 0.05;   ///< of packets; a sound cable has none
  std::uint64_t least_packets = 50;  ///< of which the share is judged
  Duration packets_kept = std::chrono::seconds(2);
  std::optional<double> turns_per_second;  ///< as the device is set; empty: learned from the first 20 scans
  double max_motor_error = 0.2;
  int motor_scans = 5;  ///< in a row
  double dirt_moved_m = 1.0;
  double dirt_turned_rad = radians(90.0);
  int dirty_bins = 3;           ///< of 2 degrees each, side by side: a drop of water on the window
  double max_lost_share = 0.3;  ///< of all beams; black and glassy surroundings stay below
  Duration lost_for = std::chrono::seconds(1);
  double blind_share = 0.8;  ///< of all beams: says no more than a silent scanner, and for no longer
  /// Angles in the scanner frame that the robot's own parts hide, low to high: never dirt.
  std::vector<std::pair<double, double>> hidden_rad;
  ScannerMountWatchOptions mount;
};

/// Watches for scanner faults. A value type.
class ScannerWatch {
 public:
  explicit ScannerWatch(const ScannerWatchOptions& options = {}) : options_(options), mount_(options.mount) {}

  /// Wheel travel, before the scans that arrive after it.
  void add_travel(const WheelTravel& travel);

  /// Fault of a scan that has just arrived, by its stamps or because it repeats the last: it must not be
  /// used.
  std::optional<ScannerFault> update(const Scan& scan, Stamp now);

  /// What the driver has read and refused since the beginning.
  void add_packets(const ScanPackets& total, Stamp now);

  /// A scan whose pose is trusted, one pose for each beam by the mount that robot.yaml has.
  void add_trusted(const Scan& scan, std::span<const Pose2> map_from_scanner, const ObstacleField& field) {
    mount_.add(scan, map_from_scanner, field);
  }

  /// Current fault of the scanner, the gravest. Silence is no fault before the first scan.
  [[nodiscard]] std::optional<ScannerFault> fault(Stamp now) const;

  /// How far the mount is turned, once that is known.
  [[nodiscard]] std::optional<double> mount_turned_rad() const { return mount_.turned_rad(); }

 private:
  static constexpr std::size_t bins = 180;  ///< of 2 degrees
  struct Packets {
    Stamp stamp;
    ScanPackets total;
  };
  /// Distance driven and angle turned by the wheels, both ways counted.
  struct Motion {
    double driven_m = 0.0;
    double turned_rad = 0.0;
  };

  [[nodiscard]] std::optional<ScannerFault> clock_fault(const Scan& scan, Stamp now) const;
  void judge_repeats(const Scan& scan, Stamp now);
  void judge_motor(const Scan& scan);
  void judge_window(const Scan& scan);
  void judge_lost(const Scan& scan, Stamp now);
  [[nodiscard]] bool is_hidden(double angle_rad) const;
  [[nodiscard]] bool is_damaged() const;

  ScannerWatchOptions options_;
  ScannerMountWatch mount_;
  std::optional<WheelTravel> last_travel_;
  Motion motion_;
  std::optional<Stamp> last_arrival_;
  std::optional<Stamp> last_beam_;
  std::optional<ScannerFault> scan_fault_;  ///< of the newest scan, by its stamps
  std::vector<double> last_ranges_m_;
  Motion last_motion_;      ///< when the newest scan came that differs from the one before
  Motion previous_motion_;  ///< when the newest scan came
  int repeats_ = 0;         ///< scans in a row like the one before
  bool has_noise_ = false;
  bool has_changed_ = false;  ///< from one scan to the next, at least once
  std::optional<Stamp> first_scan_;
  std::vector<double> first_speeds_;  ///< while the motor's is learned
  std::optional<double> turns_per_second_;
  int motor_wrong_ = 0;
  std::array<std::optional<Motion>, bins> blind_since_;
  bool is_dirty_ = false;
  std::optional<Stamp> lost_since_;
  std::optional<Stamp> blind_from_;
  bool is_losing_ = false;
  std::deque<Packets> packets_;  ///< one older than `packets_kept` first, of which those since are counted
};

}  // namespace lodestar
