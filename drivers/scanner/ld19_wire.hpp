#pragma once

#include <array>
#include <optional>

#include "drivers/scanner/bytes.hpp"

// One packet of LDROBOT's LD06, LD19 and STL-19P (LD19 development manual, section 3):
// 54 2C, speed u16, start angle u16, 12 x (distance u16, intensity u8), end angle u16, time u16, CRC-8.
namespace lodestar::ld19 {

inline constexpr std::size_t packet_size = 47;
inline constexpr std::size_t points_per_packet = 12;
inline constexpr std::uint8_t header = 0x54;
inline constexpr std::uint8_t version = 0x2C;
inline constexpr std::uint32_t time_wrap_ms = 30000;
inline constexpr std::uint32_t turn_cdeg = 36000;

struct Point {
  std::uint16_t distance_mm = 0;
  std::uint8_t intensity = 0;
  friend bool operator==(const Point&, const Point&) = default;
};

struct Packet {
  std::uint16_t speed_degps = 0;
  std::uint16_t start_cdeg = 0;  ///< of the first point: hundredths of a degree, clockwise
  std::array<Point, points_per_packet> points;
  std::uint16_t end_cdeg = 0;  ///< of the last point
  std::uint16_t time_ms = 0;   ///< of the last point; wraps at 30000
  friend bool operator==(const Packet&, const Packet&) = default;
};

/// CRC-8 with polynomial 0x4D, most significant bit first, from 0.
std::uint8_t crc8(ByteView bytes);

/// Nothing unless these are the bytes of a packet and its checksum is right.
std::optional<Packet> decode(ByteView bytes);
Bytes encode(const Packet& packet);

}  // namespace lodestar::ld19
