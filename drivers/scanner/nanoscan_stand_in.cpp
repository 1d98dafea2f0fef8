#include "drivers/scanner/nanoscan_stand_in.hpp"

#include <cmath>

#include "drivers/scanner/nanoscan_wire.hpp"
#include "drivers/scanner/turn_assembler.hpp"
#include "maps/geometry.hpp"

namespace lodestar {
namespace {

constexpr int nanoscan_beams = 1651;
constexpr double first_deg = -47.5;
constexpr double sweep_deg = 275.0;
constexpr double nanoscan_step_deg = sweep_deg / (nanoscan_beams - 1);
constexpr auto nanoscan_turn = std::chrono::milliseconds(40);
constexpr auto beam_period =
    std::chrono::microseconds(18);  // the turn's time for a step, in whole microseconds

nanoscan::Point point_of(const Beam& beam) {
  switch (beam.echo) {
    case Echo::hit: {
      const std::uint32_t distance_mm = units_of(beam, 0.001, 0xFFFF);
      if (distance_mm == 0) return {.status = nanoscan::infinite};
      return {static_cast<std::uint16_t>(distance_mm),
              static_cast<std::uint8_t>(std::lround(beam.intensity * 255.0F)), nanoscan::valid};
    }
    case Echo::too_near:
      return {.distance = 1, .status = nanoscan::valid};
    case Echo::nothing:
      return {.status = nanoscan::infinite};
    case Echo::invalid:
      return {.status = nanoscan::contamination};
  }
  return {};
}

}  // namespace

BeamPattern NanoscanStandIn::pattern() const {
  return {.beams = nanoscan_beams,
          .first_rad = radians(first_deg - 90.0),
          .step_rad = radians(nanoscan_step_deg),
          .turn = nanoscan_turn,
          .step = beam_period,
          .min_range_m = 0.05,
          .max_range_m = 40.0};
}

std::vector<TimedBytes> NanoscanStandIn::packets_of(const Scan& turn) {
  nanoscan::Telegram telegram;
  telegram.serial_number = 1;
  telegram.scan_number = ++scans_;
  telegram.scan_time_ms = static_cast<std::uint16_t>(nanoscan_turn.count());
  telegram.first_angle = static_cast<std::int32_t>(std::lround(first_deg / nanoscan::angle_unit_deg));
  telegram.angle_step = static_cast<std::int32_t>(std::lround(nanoscan_step_deg / nanoscan::angle_unit_deg));
  telegram.beam_period_us = static_cast<std::uint32_t>(beam_period.count());
  for (const Beam& beam : turn.beams) telegram.points.push_back(point_of(beam));
  std::vector<TimedBytes> packets;
  for (Bytes& fragment : nanoscan::fragments_of(nanoscan::encode(telegram), scans_))
    packets.push_back({turn.beams.back().stamp, std::move(fragment)});
  return packets;
}

}  // namespace lodestar
