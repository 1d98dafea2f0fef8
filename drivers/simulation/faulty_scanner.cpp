#include "drivers/simulation/faulty_scanner.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lodestar {
namespace {

void blind(Beam& beam, Echo echo) {
  beam.echo = echo;
  beam.range_m = 0.0;
  beam.intensity = 0.0F;
}

void drop_beams(Scan& scan, double share, Random random) {
  for (Beam& beam : scan.beams)
    if (random.uniform() < share) blind(beam, Echo::invalid);
}

/// Dirt reflects what it is hit by, or swallows it.
void soil(Scan& scan, const Fault& dirt, Random random) {
  for (Beam& beam : scan.beams) {
    const bool is_near = random.uniform() < dirt.share;
    if (std::abs(wrap_angle(beam.angle_rad - dirt.direction_rad)) <= 0.5 * dirt.width_rad)
      blind(beam, is_near ? Echo::too_near : Echo::invalid);
  }
}

/// The old scan as if measured now.
Scan repeated(Scan old, const Scan& now) {
  const Duration later = now.beams.front().stamp - old.beams.front().stamp;
  for (Beam& beam : old.beams) beam.stamp += later;
  return old;
}

void stamp_by(Scan& scan, const Fault& clock, Stamp since) {
  for (Beam& beam : scan.beams)
    beam.stamp += from_seconds(clock.delay_s + clock.drift_s_per_s * seconds(beam.stamp - since));
}

}  // namespace

void FaultyScanner::suffer(const std::vector<Fault>& active) {
  active_ = active;
  const auto of = [&](FaultKind kind) {
    const auto fault = std::ranges::find(active_, kind, &Fault::kind);
    return fault == active_.end() ? nullptr : &*fault;
  };
  const Fault* const motor = of(FaultKind::scanner_motor);
  scanner_.set_speed(motor != nullptr ? motor->share : 1.0);
  const Fault* const turned = of(FaultKind::scanner_turned);
  scanner_.turn_on_mount(turned != nullptr ? turned->turn_rad : 0.0);
  if (of(FaultKind::scanner_clock) == nullptr)
    clock_since_.reset();
  else if (!clock_since_)
    clock_since_ = now_;
}

std::optional<Scan> FaultyScanner::poll() {
  while (std::optional<Scan> scan = scanner_.poll())
    if (std::optional<Waiting> waiting = spoiled(std::move(*scan))) waiting_.push_back(std::move(*waiting));
  if (waiting_.empty() || waiting_.front().arrival > now_) return std::nullopt;
  last_ = std::move(waiting_.front().scan);
  waiting_.pop_front();
  return last_;
}

std::optional<FaultyScanner::Waiting> FaultyScanner::spoiled(Scan scan) {
  Stamp arrival = now_;
  const Random of_scan =
      Random(seed_).stream(static_cast<std::uint64_t>(scan.beams.front().stamp.time_since_epoch().count()));
  const ScanPackets before = packets_;
  packets_.read += (scan.beams.size() + beams_per_packet - 1) / beams_per_packet;
  for (std::size_t i = 0; i < active_.size() && !scan.beams.empty(); ++i) {
    const Fault& fault = active_[i];
    const Random random = of_scan.stream(i);
    switch (fault.kind) {
      case FaultKind::scanner_silent:
        packets_ = before;
        return std::nullopt;
      case FaultKind::scanner_frozen:
        if (last_) scan = repeated(*last_, scan);
        break;
      case FaultKind::scanner_beams_dropped:
        drop_beams(scan, fault.share, random);
        break;
      case FaultKind::scanner_dirty:
        soil(scan, fault, random);
        break;
      case FaultKind::scanner_late:
        arrival += from_seconds(fault.delay_s);
        break;
      case FaultKind::scanner_clock:
        stamp_by(scan, fault, clock_since_.value_or(now_));
        break;
      case FaultKind::scanner_packets_lost:
        lose_packets(scan, fault.share, random);
        break;
      default:
        break;
    }
  }
  if (scan.beams.empty()) return std::nullopt;
  return Waiting{arrival, std::move(scan)};
}

void FaultyScanner::lose_packets(Scan& scan, double share, const Random& random) {
  std::vector<Beam> kept;
  kept.reserve(scan.beams.size());
  Random chance = random;
  for (std::size_t begin = 0; begin < scan.beams.size(); begin += beams_per_packet) {
    if (chance.uniform() < share) {
      ++packets_.refused;
      --packets_.read;
      continue;
    }
    const std::size_t end = std::min(begin + beams_per_packet, scan.beams.size());
    kept.insert(kept.end(), scan.beams.begin() + static_cast<std::ptrdiff_t>(begin),
                scan.beams.begin() + static_cast<std::ptrdiff_t>(end));
  }
  scan.beams = std::move(kept);
}

}  // namespace lodestar
