#include "drivers/scanner/hosted_scanner.hpp"

#include <algorithm>

#include "drivers/system/clock.hpp"
#include "maps/geometry.hpp"

namespace lodestar {
namespace {

constexpr float plain_wall = 0.5F;  ///< intensity

}  // namespace

Scan measured_turn(const BeamPattern& pattern, Stamp begin, const RangeOfAngle& range_m) {
  Scan scan{{}, pattern.min_range_m, pattern.max_range_m};
  for (int i = 0; i < pattern.beams; ++i) {
    Beam beam;
    beam.stamp = begin + pattern.step * i;
    beam.angle_rad = wrap_angle(pattern.first_rad + pattern.step_rad * i);
    const std::optional<double> range = range_m(beam.angle_rad);
    if (!range || *range > pattern.max_range_m) {
      beam.echo = Echo::nothing;
    } else if (*range < pattern.min_range_m) {
      beam.echo = Echo::too_near;
    } else {
      beam.echo = Echo::hit;
      beam.range_m = *range;
      beam.intensity = plain_wall;
    }
    scan.beams.push_back(beam);
  }
  return scan;
}

HostedScanner::HostedScanner(std::unique_ptr<ScannerStandIn> stand_in, std::unique_ptr<ServedLink> link,
                             RangeOfAngle range_m)
    : stand_in_(std::move(stand_in)), link_(std::move(link)), range_m_(std::move(range_m)) {}

void HostedScanner::step(Stamp now) {
  const Bytes request = link_->receive();
  if (link_->client_changed()) {
    stand_in_->forget_client();
    due_.clear();
  }
  if (!request.empty()) {
    const Bytes answer = stand_in_->answer(request, now);
    if (!answer.empty()) link_->send(answer);
  }
  const BeamPattern pattern = stand_in_->pattern();
  if (now >= next_turn_) {
    if (now - next_turn_ > pattern.turn) next_turn_ = now;
    for (TimedBytes& packet : stand_in_->packets_of(measured_turn(pattern, next_turn_, range_m_)))
      due_.push_back(std::move(packet));
    next_turn_ += pattern.turn;
  }
  for (; !due_.empty() && due_.front().due <= now; due_.pop_front()) link_->send(due_.front().bytes);
}

void host(HostedScanner& scanner, const std::function<bool()>& stop) {
  constexpr Duration period = std::chrono::milliseconds(2);
  Stamp next = monotonic_now();
  while (!stop()) {
    scanner.step(monotonic_now());
    next = std::max(next + period, monotonic_now());
    sleep_until(next);
  }
}

}  // namespace lodestar
