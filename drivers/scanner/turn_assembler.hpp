#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "maps/scan.hpp"

namespace lodestar {

/// What a scanner can measure.
struct RangeLimits {
  double min_range_m = 0.0;
  double max_range_m = 0.0;
  /// What a range of zero means. Most devices write it for free space as for black cloth and lost readings;
  /// taking it for free space would clear people in dark trousers away.
  Echo zero = Echo::invalid;
};

/// A beam's range in whole units of `unit_m`, as devices write it: less than the minimum is something too
/// near, more than the maximum is nothing within it.
void set_range(Beam& beam, std::uint32_t units, double unit_m, const RangeLimits& limits);

/// The same backwards, up to `most` units; 1 for what is too near, 0 for all that has no range.
std::uint32_t units_of(const Beam& beam, double unit_m, std::uint32_t most);

/// An angle in degrees, clockwise as LDROBOT and RPLIDAR count, in [0, 360), and the house's.
double clockwise_deg(double angle_rad);
double angle_of_clockwise(double clockwise_deg);

/// Collects beams to whole turns. The first turn, which began before anyone listened, is left out.
class TurnAssembler {
 public:
  static constexpr std::size_t most_beams = 32768;  ///< of a turn; more is a stream that shows no turns
  static constexpr std::size_t most_scans = 8;      ///< that wait; then the oldest is given up

  explicit TurnAssembler(const RangeLimits& limits) : limits_(limits) {}

  /// The next beam. Stamps never run backwards within a turn: clocks that are corrected do not disturb it.
  void add(Beam beam);
  /// The next beam begins a turn.
  void begin_turn();
  /// What was collected of this turn is worthless.
  void forget();
  /// All beams of a scan at once.
  void add_scan(Scan scan);

  std::optional<Scan> next();
  [[nodiscard]] const RangeLimits& limits() const { return limits_; }

 private:
  RangeLimits limits_;
  std::vector<Beam> beams_;
  bool begun_ = false;
  std::deque<Scan> done_;
};

}  // namespace lodestar
