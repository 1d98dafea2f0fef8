#include "drivers/scanner/nanoscan_wire.hpp"

#include <algorithm>
#include <array>

namespace lodestar::nanoscan {
namespace {

constexpr std::array<std::uint8_t, 6> fragment_marker{'M', 'S', '3', ' ', 'M', 'D'};
constexpr std::size_t state_size = 16;
constexpr std::size_t derived_size = 20;
constexpr std::uint8_t contamination_error = 1U << 3U;

/// A block that the telegram's header places at this offset; empty when there is none.
ByteView block_at(ByteView bytes, std::size_t entry) {
  const std::size_t offset = number_at<std::uint16_t>(bytes, entry);
  const std::size_t size = number_at<std::uint16_t>(bytes, entry + 2);
  return offset + size <= bytes.size() ? bytes.subspan(offset, size) : ByteView();
}

void append_place(Bytes& bytes, std::size_t offset, std::size_t size) {
  append_number(bytes, static_cast<std::uint16_t>(offset));
  append_number(bytes, static_cast<std::uint16_t>(size));
}

}  // namespace

std::optional<Fragment> decode_fragment(ByteView datagram) {
  if (datagram.size() <= fragment_header_size) return std::nullopt;
  if (!std::ranges::equal(datagram.first(fragment_marker.size()), fragment_marker)) return std::nullopt;
  Fragment fragment;
  fragment.total_size = number_at<std::uint32_t>(datagram, 8);
  fragment.identification = number_at<std::uint32_t>(datagram, 12);
  fragment.offset = number_at<std::uint32_t>(datagram, 16);
  const ByteView payload = datagram.subspan(fragment_header_size);
  if (fragment.total_size > longest_telegram || fragment.offset > fragment.total_size ||
      payload.size() > fragment.total_size - fragment.offset)
    return std::nullopt;
  fragment.payload.assign(payload.begin(), payload.end());
  return fragment;
}

Bytes encode(const Fragment& fragment) {
  Bytes bytes(fragment_marker.begin(), fragment_marker.end());
  bytes.push_back(1);  // version 1.0
  bytes.push_back(0);
  append_number(bytes, fragment.total_size);
  append_number(bytes, fragment.identification);
  append_number(bytes, fragment.offset);
  append_number(bytes, std::uint32_t{0});
  append(bytes, fragment.payload);
  return bytes;
}

std::vector<Bytes> fragments_of(ByteView telegram, std::uint32_t identification) {
  std::vector<Bytes> fragments;
  for (std::size_t at = 0; at < telegram.size(); at += fragment_payload) {
    const ByteView part = telegram.subspan(at, std::min(fragment_payload, telegram.size() - at));
    fragments.push_back(encode(Fragment{static_cast<std::uint32_t>(telegram.size()),
                                        identification,
                                        static_cast<std::uint32_t>(at),
                                        {part.begin(), part.end()}}));
  }
  return fragments;
}

std::optional<Telegram> decode_telegram(ByteView bytes) {
  if (bytes.size() < telegram_header_size) return std::nullopt;
  const ByteView state = block_at(bytes, 32);
  const ByteView derived = block_at(bytes, 36);
  const ByteView measured = block_at(bytes, 40);
  if (derived.size() < derived_size || measured.size() < 4) return std::nullopt;
  const auto points = number_at<std::uint32_t>(measured, 0);
  if (points == 0 || points > (measured.size() - 4) / 4) return std::nullopt;
  Telegram telegram;
  telegram.serial_number = number_at<std::uint32_t>(bytes, 4);
  telegram.scan_number = number_at<std::uint32_t>(bytes, 20);
  telegram.window_is_dirty = !state.empty() && (state[0] & contamination_error) != 0;
  telegram.millimetres_per_unit = number_at<std::uint16_t>(derived, 0);
  telegram.scan_time_ms = number_at<std::uint16_t>(derived, 4);
  telegram.first_angle = number_at<std::int32_t>(derived, 8);
  telegram.angle_step = number_at<std::int32_t>(derived, 12);
  telegram.beam_period_us = number_at<std::uint32_t>(derived, 16);
  for (std::size_t i = 0; i < points; ++i) {
    const std::size_t at = 4 + 4 * i;
    telegram.points.push_back({number_at<std::uint16_t>(measured, at), measured[at + 2], measured[at + 3]});
  }
  return telegram;
}

Bytes encode(const Telegram& telegram) {
  Bytes bytes{'V', 1, 0, 0};
  append_number(bytes, telegram.serial_number);
  append_number(bytes, telegram.serial_number);  // of the system plug
  append_number(bytes, std::uint32_t{0});        // channel
  append_number(bytes, telegram.scan_number);    // as sequence number
  append_number(bytes, telegram.scan_number);
  append_number(bytes, std::uint32_t{0});  // date
  append_number(bytes, std::uint32_t{0});  // time
  const std::size_t derived_at = telegram_header_size + state_size;
  append_place(bytes, telegram_header_size, state_size);
  append_place(bytes, derived_at, derived_size);
  append_place(bytes, derived_at + derived_size, 4 + 4 * telegram.points.size());
  append_place(bytes, 0, 0);  // intrusion
  append_place(bytes, 0, 0);  // application
  constexpr std::uint8_t runs = 1;
  bytes.push_back(telegram.window_is_dirty ? runs | contamination_error : runs);
  bytes.resize(derived_at);
  append_number(bytes, telegram.millimetres_per_unit);
  append_number(bytes, static_cast<std::uint16_t>(telegram.points.size()));
  append_number(bytes, telegram.scan_time_ms);
  append_number(bytes, std::uint16_t{0});
  append_number(bytes, telegram.first_angle);
  append_number(bytes, telegram.angle_step);
  append_number(bytes, telegram.beam_period_us);
  append_number(bytes, static_cast<std::uint32_t>(telegram.points.size()));
  for (const Point& point : telegram.points) {
    append_number(bytes, point.distance);
    bytes.push_back(point.reflectivity);
    bytes.push_back(point.status);
  }
  return bytes;
}

}  // namespace lodestar::nanoscan
