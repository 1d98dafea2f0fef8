#include "drivers/scanner/ld19_protocol.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "maps/geometry.hpp"

namespace lodestar {
namespace {

using ld19::turn_cdeg;

constexpr double ld19_unit_m = 0.001;
constexpr std::uint32_t widest_packet_cdeg = 9000;
/// A turn at 5 Hz, the slowest: after a longer gap the next packet may be of another turn.
constexpr std::uint32_t longest_gap_ms = 200;

constexpr DeviceClockOptions ld19_clock{.ticks_to_wrap = ld19::time_wrap_ms};

}  // namespace

Ld19Protocol::Ld19Protocol(const RangeLimits& limits) : turns_(limits), clock_(ld19_clock) {}

void Ld19Protocol::connect(Stamp /*now*/) {
  stream_.clear();
  turns_ = TurnAssembler(turns_.limits());
  clock_ = DeviceClock(ld19_clock);
  last_cdeg_.reset();
  last_time_ms_.reset();
}

void Ld19Protocol::take(ByteView bytes, Stamp arrival) {
  stream_.append(bytes);
  while (const std::size_t used = take_front(stream_.front(), arrival)) stream_.drop(used);
}

/// How many bytes were used; 0 when more are needed.
std::size_t Ld19Protocol::take_front(ByteView front, Stamp arrival) {
  if (front.empty()) return 0;
  const bool may_begin = front[0] == ld19::header && (front.size() == 1 || front[1] == ld19::version);
  if (may_begin && front.size() < ld19::packet_size) return 0;
  if (may_begin) {
    const std::optional<ld19::Packet> packet = ld19::decode(front.first(ld19::packet_size));
    if (packet && take_packet(*packet, arrival)) {
      ++counts_.frames;
      return ld19::packet_size;
    }
    ++counts_.checksum_errors;
  }
  ++counts_.skipped_bytes;
  return 1;
}

/// False when its content is impossible.
bool Ld19Protocol::take_packet(const ld19::Packet& packet, Stamp arrival) {
  if (packet.start_cdeg >= turn_cdeg || packet.end_cdeg >= turn_cdeg || packet.speed_degps == 0 ||
      packet.time_ms >= ld19::time_wrap_ms)
    return false;
  const std::uint32_t span_cdeg = (packet.end_cdeg + turn_cdeg - packet.start_cdeg) % turn_cdeg;
  if (span_cdeg > widest_packet_cdeg) return false;
  if (last_time_ms_) {
    const std::uint32_t gap_ms = (packet.time_ms + ld19::time_wrap_ms - *last_time_ms_) % ld19::time_wrap_ms;
    if (gap_ms > longest_gap_ms) {
      turns_.forget();
      last_cdeg_.reset();
    }
  }
  last_time_ms_ = packet.time_ms;
  speed_degps_ = packet.speed_degps;

  const Stamp end = clock_.stamp_of(packet.time_ms, arrival);
  const double step_cdeg = span_cdeg / (ld19::points_per_packet - 1.0);
  const Duration step = from_seconds(step_cdeg / 100.0 / packet.speed_degps);
  for (std::size_t i = 0; i < ld19::points_per_packet; ++i) {
    const double raw_cdeg = packet.start_cdeg + step_cdeg * static_cast<double>(i);
    const auto cdeg = static_cast<std::uint32_t>(raw_cdeg + 0.5) % turn_cdeg;
    if (last_cdeg_ && cdeg + turn_cdeg / 2 < *last_cdeg_) turns_.begin_turn();
    last_cdeg_ = cdeg;
    Beam beam;
    beam.stamp = end - step * static_cast<int>(ld19::points_per_packet - 1 - i);
    beam.angle_rad = angle_of_clockwise(raw_cdeg / 100.0);
    set_range(beam, packet.points[i].distance_mm, ld19_unit_m, turns_.limits());
    if (beam.echo == Echo::hit) beam.intensity = static_cast<float>(packet.points[i].intensity) / 255.0F;
    turns_.add(beam);
  }
  return true;
}

std::string Ld19Protocol::description() const {
  if (speed_degps_ == 0) return "LDROBOT scanner, silent so far";
  return fmt::format("LDROBOT scanner, {:.1f} turns a second", speed_degps_ / 360.0);
}

}  // namespace lodestar
