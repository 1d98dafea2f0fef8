#pragma once

#include <array>
#include <optional>

#include "drivers/scanner/bytes.hpp"

// Slamtec's RPLIDAR protocol ("RPLIDAR interface protocol and application notes"): requests A5 .., answers
// that begin with a descriptor A5 5A, and after some of them an endless stream of frames of one kind.
namespace lodestar::rplidar {

enum class Command : std::uint8_t {
  scan = 0x20,
  stop = 0x25,
  reset = 0x40,
  info = 0x50,
  health = 0x52,
  sample_rate = 0x59,
  express_scan = 0x82,
  configuration = 0x84,
  motor_speed = 0xA8,
  motor_pwm = 0xF0,
  motor_support = 0xFF
};

/// What an answer contains.
enum class Answer : std::uint8_t {
  info = 0x04,
  health = 0x06,
  sample_rate = 0x15,
  configuration = 0x20,
  nodes = 0x81,    ///< standard scan
  express = 0x82,  ///< capsules of 32 points
  hq = 0x83,       ///< frames of 16 points with a CRC
  dense = 0x85,    ///< capsules of 40 points
  motor_support = 0xFF
};

/// Keys of Command::configuration.
enum class Setting : std::uint32_t {
  mode_count = 0x70,
  us_per_sample = 0x71,  ///< u32, in 1/256 us
  max_distance = 0x74,   ///< u32, in 1/256 m
  answer_type = 0x75,
  typical_mode = 0x7C,
  mode_name = 0x7F
};

inline constexpr std::uint8_t start_byte = 0xA5;
inline constexpr std::uint8_t answer_byte = 0x5A;
inline constexpr std::size_t descriptor_size = 7;
inline constexpr std::size_t node_size = 5;
inline constexpr std::size_t capsule_size = 84;
inline constexpr std::size_t express_points = 32;
inline constexpr std::size_t dense_points = 40;
inline constexpr std::size_t hq_size = 141;
inline constexpr std::size_t hq_points = 16;
inline constexpr std::uint32_t turn_q6 = 360 * 64;

struct Request {
  Command command = Command::stop;
  Bytes payload;
};

Bytes encode(const Request& request);
/// The first request at the front of what a client sent, and the bytes used with what stood before it; no
/// request and 0 bytes when more are needed.
struct ReadRequest {
  std::optional<Request> request;
  std::size_t used = 0;
};
ReadRequest read_request(ByteView front);

struct Descriptor {
  std::uint32_t size = 0;
  bool is_stream = false;
  Answer answer = Answer::info;
};
Bytes encode(const Descriptor& descriptor);
std::optional<Descriptor> decode_descriptor(ByteView bytes);

/// One point of a standard scan.
struct Node {
  bool begins_turn = false;
  std::uint8_t quality = 0;       ///< 0 to 63
  std::uint16_t angle_q6 = 0;     ///< 1/64 degree, clockwise
  std::uint16_t distance_q2 = 0;  ///< 1/4 mm; 0: no reading
  friend bool operator==(const Node&, const Node&) = default;
};
Bytes encode(const Node& node);
/// Nothing when the check bits contradict.
std::optional<Node> decode_node(ByteView bytes);

/// An express or dense capsule. Its points lie between its own start angle and the next capsule's.
struct Capsule {
  bool begins_stream = false;
  std::uint16_t start_q6 = 0;
  std::array<std::uint16_t, dense_points> distance_mm{};  ///< 32 of them in an express one
  std::array<std::uint8_t, express_points> back_q3{};     ///< express: point lies this far back, 1/8 degree
  friend bool operator==(const Capsule&, const Capsule&) = default;
};
Bytes encode_express(const Capsule& capsule);
Bytes encode_dense(const Capsule& capsule);
/// Nothing when sync bits or checksum are wrong.
std::optional<Capsule> decode_capsule(ByteView bytes, Answer kind);

struct HqPoint {
  std::uint16_t angle_q14 = 0;    ///< 90 / 16384 degrees, clockwise
  std::uint32_t distance_q2 = 0;  ///< 1/4 mm; 0: no reading
  std::uint8_t quality = 0;
  bool begins_turn = false;
  friend bool operator==(const HqPoint&, const HqPoint&) = default;
};
struct HqFrame {
  std::uint64_t time_us = 0;
  std::array<HqPoint, hq_points> points;
  friend bool operator==(const HqFrame&, const HqFrame&) = default;
};
Bytes encode(const HqFrame& frame);
/// Nothing when the CRC is wrong.
std::optional<HqFrame> decode_hq(ByteView bytes);

}  // namespace lodestar::rplidar
