#include "drivers/scanner/ld19_wire.hpp"

namespace lodestar::ld19 {
namespace {

constexpr std::size_t points_at = 6;
constexpr std::size_t point_size = 3;
constexpr std::size_t end_at = points_at + points_per_packet * point_size;

constexpr std::array<std::uint8_t, 256> make_table() {
  std::array<std::uint8_t, 256> table{};
  for (unsigned byte = 0; byte < table.size(); ++byte) {
    unsigned crc = byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 0x80U) != 0 ? (crc << 1U) ^ 0x4DU : crc << 1U;
    table[byte] = static_cast<std::uint8_t>(crc);
  }
  return table;
}

}  // namespace

std::uint8_t crc8(ByteView bytes) {
  static constexpr std::array<std::uint8_t, 256> table = make_table();
  std::uint8_t crc = 0;
  for (const std::uint8_t byte : bytes) crc = table[crc ^ byte];
  return crc;
}

std::optional<Packet> decode(ByteView bytes) {
  if (bytes.size() != packet_size || bytes[0] != header || bytes[1] != version) return std::nullopt;
  if (crc8(bytes.first(packet_size - 1)) != bytes.back()) return std::nullopt;
  Packet packet;
  packet.speed_degps = number_at<std::uint16_t>(bytes, 2);
  packet.start_cdeg = number_at<std::uint16_t>(bytes, 4);
  for (std::size_t i = 0; i < points_per_packet; ++i) {
    const std::size_t at = points_at + i * point_size;
    packet.points[i] = {number_at<std::uint16_t>(bytes, at), bytes[at + 2]};
  }
  packet.end_cdeg = number_at<std::uint16_t>(bytes, end_at);
  packet.time_ms = number_at<std::uint16_t>(bytes, end_at + 2);
  return packet;
}

Bytes encode(const Packet& packet) {
  Bytes bytes{header, version};
  append_number(bytes, packet.speed_degps);
  append_number(bytes, packet.start_cdeg);
  for (const Point& point : packet.points) {
    append_number(bytes, point.distance_mm);
    bytes.push_back(point.intensity);
  }
  append_number(bytes, packet.end_cdeg);
  append_number(bytes, packet.time_ms);
  bytes.push_back(crc8(bytes));
  return bytes;
}

}  // namespace lodestar::ld19
