#include "drivers/scanner/ld19_stand_in.hpp"

#include <cmath>
#include <numbers>

#include "drivers/scanner/turn_assembler.hpp"

namespace lodestar {
namespace {

constexpr int ld19_beams = 450;
constexpr Duration ld19_turn = std::chrono::milliseconds(100);

std::uint16_t centidegrees(const Beam& beam) {
  const auto cdeg = static_cast<std::uint32_t>(std::lround(clockwise_deg(beam.angle_rad) * 100.0));
  return static_cast<std::uint16_t>(cdeg % ld19::turn_cdeg);
}

ld19::Packet packet_of(std::span<const Beam> measured) {
  ld19::Packet packet;
  packet.speed_degps = static_cast<std::uint16_t>(std::lround(360.0 / seconds(ld19_turn)));
  packet.start_cdeg = centidegrees(measured.front());
  packet.end_cdeg = centidegrees(measured.back());
  const auto time_ms =
      std::chrono::floor<std::chrono::milliseconds>(measured.back().stamp.time_since_epoch()).count();
  packet.time_ms = static_cast<std::uint16_t>(time_ms % ld19::time_wrap_ms);
  for (std::size_t i = 0; i < measured.size(); ++i) {
    packet.points[i].distance_mm = static_cast<std::uint16_t>(units_of(measured[i], 0.001, 0xFFFF));
    packet.points[i].intensity = static_cast<std::uint8_t>(std::lround(measured[i].intensity * 255.0F));
  }
  return packet;
}

}  // namespace

BeamPattern Ld19StandIn::pattern() const {
  return {.beams = ld19_beams,
          .step_rad = -2.0 * std::numbers::pi / ld19_beams,
          .turn = ld19_turn,
          .step = ld19_turn / ld19_beams,
          .min_range_m = 0.02,
          .max_range_m = 12.0};
}

std::vector<TimedBytes> Ld19StandIn::packets_of(const Scan& turn) {
  waiting_.insert(waiting_.end(), turn.beams.begin(), turn.beams.end());
  std::vector<TimedBytes> packets;
  std::size_t at = 0;
  for (; at + ld19::points_per_packet <= waiting_.size(); at += ld19::points_per_packet) {
    const auto measured = std::span(waiting_).subspan(at, ld19::points_per_packet);
    packets.push_back({measured.back().stamp, ld19::encode(packet_of(measured))});
  }
  waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(at));
  return packets;
}

}  // namespace lodestar
