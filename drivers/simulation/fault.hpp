#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "maps/stamp.hpp"

// Faults of the simulated world. They reach the navigator only through its sensors.
namespace lodestar {

enum class FaultKind {
  markers_occluded,   ///< one marker, or all
  marker_wrong_id,    ///< another marker's print is mounted in its place
  marker_moved,       ///< after the survey
  marker_duplicated,  ///< a second print of the same marker, beside it
  markers_swapped,    ///< a marker and its nearest neighbour are exchanged
  decoy_lamps,        ///< as large and bright as dots, around a marker
  camera_frozen,      ///< the same image with new stamps
  camera_dropped,     ///< no frames
  camera_black,
  camera_saturated,
  camera_blurred,
  camera_late,
  clock_jump,  ///< a jump of the clock that stamps the frames
  can_loss,
  can_delay,  ///< each frame by a random time up to this: frames overtake each other
  can_duplication,
  can_corruption,  ///< truncated frames, and frames with unknown identifiers
  wheel_slip,      ///< the wheels roll farther than the robot moves
  encoder_stuck,   ///< the left wheel's encoder
  kidnapping,      ///< the robot is carried to another place
  disk_full,       ///< recordings of the drive can no longer be written
  disk_slow,       ///< each write takes `delay_s`
  // Of a robot with a scanner:
  scanner_silent,         ///< no scans
  scanner_frozen,         ///< the same scan with new stamps
  scanner_beams_dropped,  ///< a share of the beams brings nothing back
  scanner_dirty,          ///< a sector of the window sees the dirt on it, or nothing
  scanner_late,           ///< scans are delivered later
  scanner_clock,          ///< the clock that stamps the beams jumps, and drifts from there on
  scanner_motor,          ///< turns at a share of its speed
  scanner_turned,         ///< on its mount
  scanner_packets_lost,   ///< the driver refuses a share of the packets for their checksums
};

/// One fault with its time span. Which of the values apply depends on its kind.
struct Fault {
  FaultKind kind = FaultKind::markers_occluded;
  Duration begin{};  ///< since the start
  /// If set, the begin is drawn from the seed between `begin` and this.
  std::optional<Duration> latest_begin;
  std::optional<Duration> lasts;  ///< empty: to the end of the run
  std::optional<int> marker;      ///< its ID; empty: the one nearest to the robot at the begin, or all
  double shift_m = 0.0;
  double direction_rad = 0.0;  ///< of the shift in the map frame, or of the dirt in the scanner frame
  double turn_rad = 0.0;
  double count = 0.0;  ///< number of lamps
  double blur_sigma_px = 0.0;
  double delay_s = 0.0;
  double share = 0.0;          ///< of the frames, beams or packets affected, or of the motor's speed left
  double width_rad = 0.0;      ///< of the dirty sector, about `direction_rad` in the scanner frame
  double drift_s_per_s = 0.0;  ///< of the clock
  double left_share = 0.0;     ///< share of the left wheel's travel lost to slip
  double right_share = 0.0;
};

/// A fault as it occurred in one run.
struct FaultEvent {
  FaultKind kind = FaultKind::markers_occluded;
  Stamp begin;
  std::optional<Stamp> end;   ///< empty: it lasted to the end of the run
  std::optional<int> marker;  ///< the affected marker, if any
};

/// The name used in fault files, such as "wheel_slip".
std::string_view to_string(FaultKind kind);

/// Without effect on a robot that has no scanner.
bool concerns_scanner(FaultKind kind);

/// All of them, in the order of the enumeration.
std::vector<FaultKind> all_fault_kinds();

}  // namespace lodestar
