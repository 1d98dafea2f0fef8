#include "drivers/simulation/simulated_scanner.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <utility>

#include "maps/input_error.hpp"
#include "maps/random.hpp"

namespace lodestar {
namespace {

/// Scans that nobody polls are dropped, as a device's buffer does.
constexpr std::size_t most_unpolled = 16;

void expect(bool holds, const char* wanted) {
  if (!holds) throw InputError(fmt::format("simulated scanner: wanted {}", wanted));
}

SimulatedScannerOptions possible(const SimulatedScannerOptions& options) {
  expect(options.rate_hz > 0.0 && options.rate_hz <= 1000.0, "a rate of more than 0 and at most 1000 Hz");
  expect(options.beams >= 1, "at least one beam");
  expect(options.range_m > options.min_range_m && options.min_range_m >= 0.0,
         "a range above the least range, and that not negative");
  expect(options.delay >= Duration::zero(), "a delay that is not negative");
  expect(options.range_sigma_m >= 0.0 && options.spot_rad >= 0.0, "noise that is not negative");
  expect(options.invalid_share >= 0.0 && options.invalid_share <= 1.0, "a share of invalid readings in 0..1");
  return options;
}

OccupancyMap without_glass(OccupancyMap map, const std::vector<GlassPane>& glass) {
  if (glass.empty()) return map;
  for (int row = 0; row < map.rows; ++row) {
    for (int column = 0; column < map.columns; ++column) {
      const Vec2 center_m = map.center_of({column, row});
      const bool is_glass = std::ranges::any_of(glass, [&](const GlassPane& pane) {
        return (center_m.array() >= pane.low_m.array()).all() &&
               (center_m.array() <= pane.high_m.array()).all();
      });
      if (is_glass) map.cells[map.index({column, row})] = OccupancyMap::free;
    }
  }
  return map;
}

}  // namespace

SimulatedScanner::SimulatedScanner(const OccupancyMap& map, const SimulatedScannerOptions& options,
                                   std::uint64_t seed)
    : options_(possible(options)),
      seed_(seed),
      map_(without_glass(map, options.glass)),
      base_from_scanner_(options.mount.base_from_scanner) {
  beams_.reserve(static_cast<std::size_t>(options_.beams));
}

void SimulatedScanner::change_map(const OccupancyMap& map) {
  map_ = without_glass(map, options_.glass);
}

void SimulatedScanner::turn_on_mount(double turned_rad) {
  base_from_scanner_ = options_.mount.base_from_scanner;
  base_from_scanner_.yaw_rad += turned_rad;
}

/// Of a beam of the present turn.
Stamp SimulatedScanner::stamp_of(int beam) const {
  const double turns =
      static_cast<double>(turn_ - speed_first_turn_) + static_cast<double>(beam) / options_.beams;
  return speed_begin_ + from_seconds(turns / turns_per_second());
}

void SimulatedScanner::observe(Stamp now, const Pose2& true_map_from_base, std::span<const DiscState> discs) {
  const Observation current{now, true_map_from_base};
  if (!last_) last_ = current;
  visible_.clear();
  for (const DiscState& disc : discs) append_visible(disc, visible_);
  while (true) {
    const auto beam = static_cast<int>(beams_.size());
    const Stamp stamp = stamp_of(beam);
    if (stamp > now) break;
    const double span_s = seconds(now - last_->stamp);
    const double share = span_s > 0.0 ? std::max(0.0, seconds(stamp - last_->stamp) / span_s) : 1.0;
    const Pose2& from = last_->map_from_base;
    const Pose2 map_from_base{
        from.position_m + share * (current.map_from_base.position_m - from.position_m),
        from.yaw_rad + share * wrap_angle(current.map_from_base.yaw_rad - from.yaw_rad)};
    const double angle_rad = std::numbers::pi * (2.0 * (beam + 1.0) / options_.beams - 1.0);
    const auto seen = reflection(map_from_base * base_from_scanner_, angle_rad, seconds(stamp - now));
    beams_.push_back(measure(stamp, angle_rad, seen));
    previous_ = seen;
    if (beam + 1 == options_.beams) finish_turn();
  }
  last_ = current;
  now_ = now;
}

std::optional<SimulatedScanner::Reflection> SimulatedScanner::reflection(const Pose2& map_from_scanner,
                                                                         double angle_rad,
                                                                         double later_s) const {
  const double heading_rad = map_from_scanner.yaw_rad + angle_rad;
  const Vec2 direction(std::cos(heading_rad), std::sin(heading_rad));
  std::optional<RayHit> nearest = cast_ray(map_, map_from_scanner.position_m, heading_rad, options_.range_m);
  double reflectivity = options_.wall_reflectivity;
  for (const VisibleDisc& disc : visible_) {
    const Vec2 center_m = disc.center_m + later_s * disc.velocity_mps;
    const auto hit = cast_ray_at_disc(map_from_scanner.position_m, direction, center_m, disc.radius_m);
    if (!hit || hit->range_m > options_.range_m || (nearest && nearest->range_m <= hit->range_m)) continue;
    nearest = hit;
    reflectivity = options_.disc_reflectivity;
  }
  if (!nearest) return std::nullopt;
  // A matt surface (Lambert) in the far field: the signal falls with the square of the range.
  const double relative_range = std::max(nearest->range_m, 1e-3) / options_.range_m;
  const double signal =
      reflectivity * nearest->incidence_cos / (options_.rated_reflectivity * square(relative_range));
  return Reflection{nearest->range_m, signal};
}

Beam SimulatedScanner::measure(Stamp stamp, double angle_rad, const std::optional<Reflection>& seen) {
  Beam beam{.stamp = stamp, .angle_rad = angle_rad, .echo = Echo::nothing};
  Random random = Random(seed_).stream(turn_).stream(beams_.size());
  if (random.uniform() < options_.invalid_share) {
    beam.echo = Echo::invalid;
    return beam;
  }
  // Speckle: the rated signal is detected every other time, one and a half times that always.
  if (!seen || seen->signal < 0.5 + random.uniform()) return beam;
  double range_m = seen->range_m;
  const double between_beams_rad = 2.0 * std::numbers::pi / options_.beams;
  const bool has_step = previous_ && std::abs(previous_->range_m - range_m) > options_.mixed_from_m;
  if (has_step && random.uniform() < options_.spot_rad / between_beams_rad)
    range_m += random.uniform() * (previous_->range_m - range_m);
  if (range_m < options_.min_range_m) {
    beam.echo = Echo::too_near;
    return beam;
  }
  beam.range_m =
      std::clamp(range_m + options_.range_sigma_m * random.normal(), options_.min_range_m, options_.range_m);
  // The receiver's scale is logarithmic: full at a hundred times the rated signal.
  beam.intensity = static_cast<float>(std::clamp(std::log10(1.0 + seen->signal) / 2.0, 0.0, 1.0));
  beam.echo = Echo::hit;
  return beam;
}

void SimulatedScanner::finish_turn() {
  Scan scan{.beams = std::exchange(beams_, {}),
            .min_range_m = options_.min_range_m,
            .max_range_m = options_.range_m};
  beams_.reserve(scan.beams.size());
  const Stamp arrival = scan.beams.front().stamp + from_seconds(1.0 / turns_per_second()) + options_.delay;
  on_their_way_.push_back({std::move(scan), arrival});
  if (on_their_way_.size() > most_unpolled) on_their_way_.pop_front();
  ++turn_;
  if (next_speed_share_ == speed_share_) return;
  speed_begin_ = stamp_of(0);
  speed_first_turn_ = turn_;
  speed_share_ = next_speed_share_;
}

std::optional<Scan> SimulatedScanner::poll() {
  if (on_their_way_.empty() || on_their_way_.front().arrival > now_) return std::nullopt;
  Scan scan = std::move(on_their_way_.front().scan);
  on_their_way_.pop_front();
  return scan;
}

}  // namespace lodestar
