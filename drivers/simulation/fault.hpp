#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "maps/stamp.hpp"

// What can go wrong in the simulated world. Nothing of it reaches the navigator but by its sensors.
namespace lodestar {

enum class FaultKind {
  markers_occluded,   ///< a marker, or all of them
  marker_wrong_id,    ///< somebody has hung another marker's print there
  marker_moved,       ///< after the survey
  marker_duplicated,  ///< a second print of the same marker, beside it
  markers_swapped,    ///< a marker and its nearest neighbour
  decoy_lamps,        ///< as large and bright as dots, around a marker
  camera_frozen,      ///< the same picture with new stamps
  camera_dropped,     ///< no frames
  camera_black,
  camera_saturated,
  camera_blurred,
  camera_late,
  clock_jump,  ///< of the clock that stamps the frames
  can_loss,
  can_delay,  ///< each frame by another time up to this: frames overtake each other
  can_duplication,
  can_corruption,  ///< frames cut short, and frames with foreign identifiers
  wheel_slip,      ///< the wheels turn farther than the floor goes by
  encoder_stuck,   ///< the left one
  kidnapping,      ///< somebody puts the robot elsewhere
  disk_full,       ///< of what the drive leaves, nothing more is taken
  disk_slow,       ///< each write takes so long
};

/// One thing that goes wrong for a while. Which of the values count depends on its kind.
struct Fault {
  FaultKind kind = FaultKind::markers_occluded;
  Duration begin{};                      ///< since the start
  std::optional<Duration> latest_begin;  ///< when begin is only the earliest: then the seed decides
  std::optional<Duration> lasts;         ///< nothing: to the end
  std::optional<int> marker;  ///< its ID; nothing: the one nearest to the robot at the begin, or all
  double shift_m = 0.0;
  double direction_rad = 0.0;  ///< of the shift, in the map frame
  double turn_rad = 0.0;
  double count = 0.0;  ///< of lamps
  double blur_sigma_px = 0.0;
  double delay_s = 0.0;
  double share = 0.0;       ///< of the frames
  double left_share = 0.0;  ///< of the left wheel's travel that is lost to the floor
  double right_share = 0.0;
};

/// What came of a fault in one run.
struct FaultEvent {
  FaultKind kind = FaultKind::markers_occluded;
  Stamp begin;
  std::optional<Stamp> end;   ///< nothing: it lasted to the end of the run
  std::optional<int> marker;  ///< that it befell, where it befell one
};

/// As in fault files: "wheel_slip".
std::string_view to_string(FaultKind kind);

/// All of them, in the order of the enumeration.
std::vector<FaultKind> all_fault_kinds();

}  // namespace lodestar
