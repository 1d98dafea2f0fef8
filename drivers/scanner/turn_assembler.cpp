#include "drivers/scanner/turn_assembler.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "maps/geometry.hpp"

namespace lodestar {

void set_range(Beam& beam, std::uint32_t units, double unit_m, const RangeLimits& limits) {
  const double range_m = units * unit_m;
  if (units == 0) {
    beam.echo = limits.zero;
  } else if (range_m < limits.min_range_m) {
    beam.echo = Echo::too_near;
  } else if (range_m > limits.max_range_m) {
    beam.echo = Echo::nothing;
  } else {
    beam.echo = Echo::hit;
    beam.range_m = range_m;
  }
}

std::uint32_t units_of(const Beam& beam, double unit_m, std::uint32_t most) {
  if (beam.echo == Echo::too_near) return 1;
  if (beam.echo != Echo::hit) return 0;
  const double units = std::round(beam.range_m / unit_m);
  return units >= 1.0 && units <= most ? static_cast<std::uint32_t>(units) : 0;
}

double clockwise_deg(double angle_rad) {
  const double clockwise = degrees(wrap_angle(-angle_rad));
  return clockwise < 0.0 ? clockwise + 360.0 : clockwise;
}

double angle_of_clockwise(double clockwise_deg) {
  return wrap_angle(-radians(clockwise_deg));
}

void TurnAssembler::add(Beam beam) {
  if (!begun_) return;
  if (beams_.size() == most_beams) return forget();
  if (!beams_.empty()) beam.stamp = std::max(beam.stamp, beams_.back().stamp);
  beams_.push_back(beam);
}

void TurnAssembler::begin_turn() {
  if (begun_ && !beams_.empty())
    add_scan({std::exchange(beams_, {}), limits_.min_range_m, limits_.max_range_m});
  begun_ = true;
}

void TurnAssembler::forget() {
  beams_.clear();
  begun_ = false;
}

void TurnAssembler::add_scan(Scan scan) {
  if (done_.size() == most_scans) done_.pop_front();
  done_.push_back(std::move(scan));
}

std::optional<Scan> TurnAssembler::next() {
  if (done_.empty()) return std::nullopt;
  Scan scan = std::move(done_.front());
  done_.pop_front();
  return scan;
}

}  // namespace lodestar
