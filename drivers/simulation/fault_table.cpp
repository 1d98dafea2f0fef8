#include "drivers/simulation/fault_table.hpp"

#include <array>

#include "maps/geometry.hpp"

namespace lodestar {
namespace {

constexpr FaultParameter shift{"shift_m", 0.001, 20.0, &Fault::shift_m};
constexpr FaultParameter direction{"direction_deg", -360.0, 360.0, &Fault::direction_rad, radians(1.0)};
constexpr FaultParameter turn{"turn_deg", -360.0, 360.0, &Fault::turn_rad, radians(1.0)};
constexpr FaultParameter share{"share", 0.0, 1.0, &Fault::share};

constexpr std::array shift_and_turn{shift, direction, turn};
constexpr std::array lamps{FaultParameter{"count", 1.0, 200.0, &Fault::count},
                           FaultParameter{"shift_m", 0.01, 2.0, &Fault::shift_m}};
constexpr std::array blur{FaultParameter{"blur_sigma_px", 0.1, 50.0, &Fault::blur_sigma_px}};
constexpr std::array delay{FaultParameter{"delay_s", 0.0, 10.0, &Fault::delay_s}};
constexpr std::array jump{FaultParameter{"jump_s", -1e5, 1e5, &Fault::delay_s}};
constexpr std::array of_frames{share};  // or of beams, or packets
constexpr std::array of_travel{FaultParameter{"left_share", -1.0, 1.0, &Fault::left_share},
                               FaultParameter{"right_share", -1.0, 1.0, &Fault::right_share}};
constexpr std::array carried{shift, turn};
constexpr std::array dirt{direction, FaultParameter{"width_deg", 0.1, 360.0, &Fault::width_rad, radians(1.0)},
                          FaultParameter{"near_share", 0.0, 1.0, &Fault::share}};
constexpr std::array foreign_clock{FaultParameter{"jump_s", -1e5, 1e5, &Fault::delay_s},
                                   FaultParameter{"drift_s_per_s", -0.5, 0.5, &Fault::drift_s_per_s}};
constexpr std::array speed{FaultParameter{"speed_share", 0.05, 3.0, &Fault::share}};
constexpr std::array turned{turn};

constexpr FaultRow of_scanner(FaultKind kind, std::string_view name,
                              std::span<const FaultParameter> parameters) {
  return {kind, name, parameters, false, false, true};
}

using enum FaultKind;
constexpr std::array table{
    FaultRow{markers_occluded, "markers_occluded", {}, true},
    FaultRow{marker_wrong_id, "marker_wrong_id", {}, true},
    FaultRow{marker_moved, "marker_moved", shift_and_turn, true},
    FaultRow{marker_duplicated, "marker_duplicated", shift_and_turn, true},
    FaultRow{markers_swapped, "markers_swapped", {}, true},
    FaultRow{decoy_lamps, "decoy_lamps", lamps, true},
    FaultRow{camera_frozen, "camera_frozen", {}},
    FaultRow{camera_dropped, "camera_dropped", {}},
    FaultRow{camera_black, "camera_black", {}},
    FaultRow{camera_saturated, "camera_saturated", {}},
    FaultRow{camera_blurred, "camera_blurred", blur},
    FaultRow{camera_late, "camera_late", delay},
    FaultRow{clock_jump, "clock_jump", jump},
    FaultRow{can_loss, "can_loss", of_frames},
    FaultRow{can_delay, "can_delay", delay},
    FaultRow{can_duplication, "can_duplication", of_frames},
    FaultRow{can_corruption, "can_corruption", of_frames},
    FaultRow{wheel_slip, "wheel_slip", of_travel},
    FaultRow{encoder_stuck, "encoder_stuck", {}},
    FaultRow{kidnapping, "kidnapping", carried, false, true},
    FaultRow{disk_full, "disk_full", {}},
    FaultRow{disk_slow, "disk_slow", delay},
    of_scanner(scanner_silent, "scanner_silent", {}),
    of_scanner(scanner_frozen, "scanner_frozen", {}),
    of_scanner(scanner_beams_dropped, "scanner_beams_dropped", of_frames),
    of_scanner(scanner_dirty, "scanner_dirty", dirt),
    of_scanner(scanner_late, "scanner_late", delay),
    of_scanner(scanner_clock, "scanner_clock", foreign_clock),
    of_scanner(scanner_motor, "scanner_motor", speed),
    of_scanner(scanner_turned, "scanner_turned", turned),
    of_scanner(scanner_packets_lost, "scanner_packets_lost", of_frames),
};

}  // namespace

std::span<const FaultRow> fault_table() {
  return table;
}

std::string_view to_string(FaultKind kind) {
  return table[static_cast<std::size_t>(kind)].name;
}

bool concerns_scanner(FaultKind kind) {
  return table[static_cast<std::size_t>(kind)].concerns_scanner;
}

std::vector<FaultKind> all_fault_kinds() {
  std::vector<FaultKind> kinds;
  for (const FaultRow& row : table) kinds.push_back(row.kind);
  return kinds;
}

}  // namespace lodestar
