#include "drivers/scanner/nanoscan_protocol.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "maps/geometry.hpp"

namespace lodestar {
namespace {

constexpr std::size_t most_partials = 4;
constexpr double ahead_deg = 90.0;

DeviceClockOptions clock_of(Duration scan_time) {
  return {.tick = scan_time, .ticks_to_wrap = std::uint64_t{1} << 32U};
}

void set_echo(Beam& beam, const nanoscan::Point& point, double unit_m, const RangeLimits& limits) {
  if ((point.status & (nanoscan::glare | nanoscan::contamination)) != 0) return;
  if ((point.status & nanoscan::infinite) != 0) {
    beam.echo = Echo::nothing;
    return;
  }
  if ((point.status & nanoscan::valid) == 0) return;
  set_range(beam, point.distance, unit_m, limits);
  if (beam.echo == Echo::hit) beam.intensity = static_cast<float>(point.reflectivity) / 255.0F;
}

}  // namespace

NanoscanProtocol::NanoscanProtocol(const RangeLimits& limits) : scans_(limits) {
  scans_ = TurnAssembler({limits.min_range_m, limits.max_range_m, Echo::too_near});
}

void NanoscanProtocol::connect(Stamp /*now*/) {
  partials_.clear();
  scans_ = TurnAssembler(scans_.limits());
  scan_time_ = Duration::zero();
  window_is_dirty_ = false;
}

NanoscanProtocol::Partial& NanoscanProtocol::partial_of(const nanoscan::Fragment& fragment) {
  for (Partial& partial : partials_) {
    if (partial.identification == fragment.identification && partial.bytes.size() == fragment.total_size)
      return partial;
  }
  if (partials_.size() == most_partials) {
    counts_.skipped_bytes += partials_.front().bytes.size() - partials_.front().missing;
    partials_.pop_front();
  }
  partials_.push_back({fragment.identification, Bytes(fragment.total_size),
                       std::vector<bool>(fragment.total_size), fragment.total_size});
  return partials_.back();
}

void NanoscanProtocol::take(ByteView datagram, Stamp arrival) {
  const std::optional<nanoscan::Fragment> fragment = nanoscan::decode_fragment(datagram);
  if (!fragment) {
    counts_.skipped_bytes += datagram.size();
    return;
  }
  Partial& partial = partial_of(*fragment);
  for (std::size_t i = 0; i < fragment->payload.size(); ++i) {
    const std::size_t at = fragment->offset + i;
    if (!partial.known[at]) --partial.missing;
    partial.known[at] = true;
    partial.bytes[at] = fragment->payload[i];
  }
  if (partial.missing > 0) return;
  const std::optional<nanoscan::Telegram> telegram = nanoscan::decode_telegram(partial.bytes);
  std::erase_if(partials_, [&](const Partial& kept) { return &kept == &partial; });
  if (telegram && take_telegram(*telegram, arrival))
    ++counts_.frames;
  else
    ++counts_.checksum_errors;
}

/// False when its content is impossible.
bool NanoscanProtocol::take_telegram(const nanoscan::Telegram& telegram, Stamp arrival) {
  constexpr double turn_deg = 360.0;
  const double step_deg = telegram.angle_step * nanoscan::angle_unit_deg;
  const auto beams = static_cast<int>(telegram.points.size());
  const Duration beam_period = std::chrono::microseconds(telegram.beam_period_us);
  if (telegram.millimetres_per_unit == 0 || telegram.scan_time_ms == 0 || step_deg <= 0.0 ||
      step_deg * beams > turn_deg + step_deg ||
      beam_period * beams > 2 * std::chrono::milliseconds(telegram.scan_time_ms))
    return false;
  serial_number_ = telegram.serial_number;
  window_is_dirty_ = telegram.window_is_dirty;
  const Duration scan_time = std::chrono::milliseconds(telegram.scan_time_ms);
  if (scan_time != scan_time_) clock_ = DeviceClock(clock_of(scan_time));
  scan_time_ = scan_time;

  // The mirror turns steadily, and the scan's number counts its turns, also those whose telegrams are lost.
  const Stamp end = clock_.stamp_of(telegram.scan_number, arrival);
  Scan scan{{}, scans_.limits().min_range_m, scans_.limits().max_range_m};
  scan.beams.reserve(telegram.points.size());
  for (int i = 0; i < beams; ++i) {
    Beam beam;
    beam.stamp = end - beam_period * (beams - 1 - i);
    beam.angle_rad =
        wrap_angle(radians(telegram.first_angle * nanoscan::angle_unit_deg + step_deg * i - ahead_deg));
    set_echo(beam, telegram.points[static_cast<std::size_t>(i)], telegram.millimetres_per_unit / mm_per_m,
             scans_.limits());
    scan.beams.push_back(beam);
  }
  scans_.add_scan(std::move(scan));
  return true;
}

std::string NanoscanProtocol::description() const {
  if (scan_time_ == Duration::zero()) return "SICK safety scanner, silent so far";
  return fmt::format("SICK safety scanner {}, {:.1f} turns a second{}", serial_number_,
                     1.0 / seconds(scan_time_), window_is_dirty_ ? ", its window is dirty" : "");
}

}  // namespace lodestar
