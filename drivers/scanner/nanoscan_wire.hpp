#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/scanner/bytes.hpp"

// SICK nanoScan3, microScan3 and outdoorScan3: measurement output over UDP. A telegram is a header with the
// places of its blocks, and the blocks; it is sent in fragments, each with a header of 24 bytes. Layout as
// the maker's own open-source driver (sick_safetyscanners_base) reads it.
namespace lodestar::nanoscan {

inline constexpr std::size_t fragment_header_size = 24;
inline constexpr std::size_t fragment_payload =
    1436;  ///< with its header and those of UDP and IP: below 1500
inline constexpr std::size_t telegram_header_size = 52;
inline constexpr std::uint32_t longest_telegram = 0xFFFF;
inline constexpr double angle_unit_deg = 1.0 / 4194304.0;

/// Bits of a point's status.
inline constexpr std::uint8_t valid = 1U << 0U;
inline constexpr std::uint8_t infinite = 1U << 1U;
inline constexpr std::uint8_t glare = 1U << 2U;
inline constexpr std::uint8_t reflector = 1U << 3U;
inline constexpr std::uint8_t contamination = 1U << 4U;
inline constexpr std::uint8_t contamination_warning = 1U << 5U;

struct Fragment {
  std::uint32_t total_size = 0;  ///< of the telegram
  std::uint32_t identification = 0;
  std::uint32_t offset = 0;  ///< of the payload in the telegram
  Bytes payload;
};
/// Nothing when these are not the bytes of a fragment, or it does not fit its telegram.
std::optional<Fragment> decode_fragment(ByteView datagram);
Bytes encode(const Fragment& fragment);
std::vector<Bytes> fragments_of(ByteView telegram, std::uint32_t identification);

struct Point {
  std::uint16_t distance = 0;  ///< times Telegram::millimetres_per_unit
  std::uint8_t reflectivity = 0;
  std::uint8_t status = 0;
  friend bool operator==(const Point&, const Point&) = default;
};

struct Telegram {
  std::uint32_t serial_number = 0;
  std::uint32_t scan_number = 0;
  bool window_is_dirty = false;  ///< contamination error of the whole device
  std::uint16_t millimetres_per_unit = 1;
  std::uint16_t scan_time_ms = 0;
  std::int32_t first_angle = 0;  ///< in angle_unit_deg, counter-clockwise; 90 degrees is ahead
  std::int32_t angle_step = 0;
  std::uint32_t beam_period_us = 0;
  std::vector<Point> points;
  friend bool operator==(const Telegram&, const Telegram&) = default;
};
/// Nothing when a needed block is missing or does not lie within the bytes.
std::optional<Telegram> decode_telegram(ByteView bytes);
Bytes encode(const Telegram& telegram);

}  // namespace lodestar::nanoscan
