#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "drivers/scanner/scanner.hpp"
#include "drivers/simulation/moving_disc.hpp"
#include "maps/occupancy_map.hpp"
#include "maps/ray_casting.hpp"

namespace lodestar {

/// A pane that reaches from the floor to above the scanner. Its beams pass, the robot does not.
struct GlassPane {
  // Opposite corners of an upright box in the map; cells whose centres are inside are of glass.
  Vec2 low_m = Vec2::Zero();
  Vec2 high_m = Vec2::Zero();
};

/// A scanner of the LDROBOT LD19 or RPLIDAR A class; what the figures are from stands with them.
struct SimulatedScannerOptions {
  ScannerMount mount;
  double rate_hz = 10.0;      ///< turns per second: LD19, A1, A2
  int beams = 720;            ///< per turn, half a degree apart: A2 in its express mode
  double range_m = 12.0;      ///< LD19, A1 and A2, on a surface that reflects `rated_reflectivity`
  double min_range_m = 0.05;  ///< LD19 manual: 0.03 m; A1: 0.15 m
  /// From the end of a turn to delivery: one capsule of latency and a serial line at 230400 Bd.
  Duration delay = std::chrono::milliseconds(30);
  double range_sigma_m = 0.01;  ///< LD19 manual: 10 mm from 0.3 m on
  /// Width of the spot. Where its halves meet surfaces at different ranges, it reports one in between
  /// (a mixed pixel: the veil in front of edges).
  double spot_rad = 0.003;
  double mixed_from_m = 0.1;        ///< a smaller step of the range is within one pulse
  double rated_reflectivity = 0.7;  ///< A1 data sheet: 12 m on a white object
  double wall_reflectivity = 0.6;   ///< painted wall or wood
  double disc_reflectivity = 0.4;   ///< mean of clothing
  double invalid_share = 0.001;     ///< readings that fail for no cause in the scene
  std::vector<GlassPane> glass;
};

/// A laser scanner on the simulated robot. Turn k begins k periods after time 0; its beams go
/// counter-clockwise from behind, each cast from the robot's true pose at its own time. Equal seeds and
/// equal drives give equal scans.
class SimulatedScanner final : public Scanner {
 public:
  /// Throws InputError unless rate, beams, ranges and shares are possible.
  SimulatedScanner(const OccupancyMap& map, const SimulatedScannerOptions& options, std::uint64_t seed);

  /// The base's true pose and all discs at `now`. Stamps ascend; motion is interpolated linearly.
  void observe(Stamp now, const Pose2& true_map_from_base, std::span<const DiscState> discs);

  /// Replaces the map of obstacles; the glass stays.
  void change_map(const OccupancyMap& map);

  /// From the next turn on, at this share of its rate.
  void set_speed(double share) { next_speed_share_ = share; }

  /// The scanner turned so far, counter-clockwise, on the mount that the robot believes in.
  void turn_on_mount(double turned_rad);

  std::optional<Scan> poll() override;
  [[nodiscard]] std::string description() const override { return "simulated scanner"; }

 private:
  struct OnItsWay {
    Scan scan;
    Stamp arrival;
  };
  struct Observation {
    Stamp stamp;
    Pose2 map_from_base;
  };
  /// What a beam would find without noise.
  struct Reflection {
    double range_m = 0.0;
    double signal = 0.0;  ///< over the least that is always detected at the rated range
  };

  [[nodiscard]] Stamp stamp_of(int beam) const;
  [[nodiscard]] double turns_per_second() const { return options_.rate_hz * speed_share_; }
  /// `later_s`: than the visible discs' positions, not positive.
  [[nodiscard]] std::optional<Reflection> reflection(const Pose2& map_from_scanner, double angle_rad,
                                                     double later_s) const;
  [[nodiscard]] Beam measure(Stamp stamp, double angle_rad, const std::optional<Reflection>& seen);
  void finish_turn();

  SimulatedScannerOptions options_;
  std::uint64_t seed_;
  OccupancyMap map_;  ///< as the beams meet it
  std::optional<Observation> last_;
  std::vector<VisibleDisc> visible_;
  Pose2 base_from_scanner_;  ///< the true one
  std::uint64_t turn_ = 0;
  // Since the motor last changed its speed.
  double speed_share_ = 1.0;
  Stamp speed_begin_;
  std::uint64_t speed_first_turn_ = 0;
  double next_speed_share_ = 1.0;
  std::vector<Beam> beams_;  ///< of this turn so far
  std::optional<Reflection> previous_;
  std::deque<OnItsWay> on_their_way_;
  Stamp now_;
};

}  // namespace lodestar
