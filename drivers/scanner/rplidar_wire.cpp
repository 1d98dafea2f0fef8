#include "drivers/scanner/rplidar_wire.hpp"

namespace lodestar::rplidar {
namespace {

constexpr std::uint8_t has_payload = 0x80;
constexpr unsigned sync_high = 0xA0;
constexpr unsigned sync_low = 0x50;
constexpr std::uint16_t begins_stream_bit = 0x8000;

/// Both sync bytes with the checksum of what follows them.
Bytes finished(Bytes capsule) {
  const unsigned sum = xor_of(ByteView(capsule).subspan(2));
  capsule[0] = static_cast<std::uint8_t>(sync_high | (sum & 0x0FU));
  capsule[1] = static_cast<std::uint8_t>(sync_low | (sum >> 4U));
  return capsule;
}

Bytes begun(const Capsule& capsule) {
  Bytes bytes(2);
  const unsigned bit = capsule.begins_stream ? begins_stream_bit : 0U;
  append_number(bytes, static_cast<std::uint16_t>(capsule.start_q6 | bit));
  return bytes;
}

/// As of Ethernet and zip: reflected polynomial 0x04C11DB7.
std::uint32_t crc32(ByteView bytes) {
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1U) ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
  }
  return ~crc;
}

/// Of all but the checksum itself, filled up with zeros to whole words.
std::uint32_t checksum_of_hq(ByteView frame) {
  Bytes padded(frame.begin(), frame.begin() + hq_size - 4);
  padded.resize((padded.size() + 3) / 4 * 4);
  return crc32(padded);
}

}  // namespace

Bytes encode(const Request& request) {
  const auto command = static_cast<std::uint8_t>(request.command);
  Bytes bytes{start_byte, command};
  if ((command & has_payload) == 0) return bytes;
  bytes.push_back(static_cast<std::uint8_t>(request.payload.size()));
  append(bytes, request.payload);
  bytes.push_back(xor_of(bytes));
  return bytes;
}

ReadRequest read_request(ByteView front) {
  std::size_t begin = 0;
  while (begin < front.size() && front[begin] != start_byte) ++begin;
  const ByteView bytes = front.subspan(begin);
  if (bytes.size() < 2) return {.used = begin};
  const auto command = static_cast<Command>(bytes[1]);
  if ((bytes[1] & has_payload) == 0) return {Request{command, {}}, begin + 2};
  if (bytes.size() < 3) return {.used = begin};
  const std::size_t size = bytes[2];
  if (bytes.size() < size + 4) return {.used = begin};
  if (xor_of(bytes.first(size + 4)) != 0) return {.used = begin + 1};
  const ByteView payload = bytes.subspan(3, size);
  return {Request{command, {payload.begin(), payload.end()}}, begin + size + 4};
}

Bytes encode(const Descriptor& descriptor) {
  Bytes bytes{start_byte, answer_byte};
  append_number(bytes, descriptor.size | (descriptor.is_stream ? 1U << 30U : 0U));
  bytes.push_back(static_cast<std::uint8_t>(descriptor.answer));
  return bytes;
}

std::optional<Descriptor> decode_descriptor(ByteView bytes) {
  if (bytes.size() != descriptor_size || bytes[0] != start_byte || bytes[1] != answer_byte)
    return std::nullopt;
  const auto word = number_at<std::uint32_t>(bytes, 2);
  if (word >> 30U > 1) return std::nullopt;
  return Descriptor{word & 0x3FFFFFFFU, word >> 30U == 1, static_cast<Answer>(bytes[6])};
}

Bytes encode(const Node& node) {
  const unsigned quality = node.quality;
  const unsigned angle_q6 = node.angle_q6;
  Bytes bytes{static_cast<std::uint8_t>((quality << 2U) | (node.begins_turn ? 1U : 2U))};
  append_number(bytes, static_cast<std::uint16_t>((angle_q6 << 1U) | 1U));
  append_number(bytes, node.distance_q2);
  return bytes;
}

std::optional<Node> decode_node(ByteView bytes) {
  const bool begins = (bytes[0] & 1U) != 0;
  const bool continues = (bytes[0] & 2U) != 0;
  const auto angle = number_at<std::uint16_t>(bytes, 1);
  if (begins == continues || (angle & 1U) == 0 || (angle >> 1U) > turn_q6) return std::nullopt;
  return Node{begins, static_cast<std::uint8_t>(bytes[0] >> 2U), static_cast<std::uint16_t>(angle >> 1U),
              number_at<std::uint16_t>(bytes, 3)};
}

Bytes encode_express(const Capsule& capsule) {
  Bytes bytes = begun(capsule);
  for (std::size_t i = 0; i < express_points; i += 2) {
    const unsigned back_1 = capsule.back_q3[i];
    const unsigned back_2 = capsule.back_q3[i + 1];
    const unsigned mm_1 = capsule.distance_mm[i];
    const unsigned mm_2 = capsule.distance_mm[i + 1];
    append_number(bytes, static_cast<std::uint16_t>((mm_1 << 2U) | (back_1 >> 4U)));
    append_number(bytes, static_cast<std::uint16_t>((mm_2 << 2U) | (back_2 >> 4U)));
    bytes.push_back(static_cast<std::uint8_t>((back_1 & 0x0FU) | ((back_2 & 0x0FU) << 4U)));
  }
  return finished(std::move(bytes));
}

Bytes encode_dense(const Capsule& capsule) {
  Bytes bytes = begun(capsule);
  for (const std::uint16_t distance_mm : capsule.distance_mm) append_number(bytes, distance_mm);
  return finished(std::move(bytes));
}

std::optional<Capsule> decode_capsule(ByteView bytes, Answer kind) {
  if (bytes.size() != capsule_size || (bytes[0] & 0xF0U) != sync_high || (bytes[1] & 0xF0U) != sync_low)
    return std::nullopt;
  const unsigned sum = (bytes[0] & 0x0FU) | ((bytes[1] & 0x0FU) << 4U);
  if (sum != xor_of(bytes.subspan(2))) return std::nullopt;
  Capsule capsule;
  const auto start = number_at<std::uint16_t>(bytes, 2);
  capsule.begins_stream = (start & begins_stream_bit) != 0;
  capsule.start_q6 = start & 0x7FFFU;
  if (capsule.start_q6 > turn_q6) return std::nullopt;
  if (kind == Answer::dense) {
    for (std::size_t i = 0; i < dense_points; ++i)
      capsule.distance_mm[i] = number_at<std::uint16_t>(bytes, 4 + 2 * i);
    return capsule;
  }
  for (std::size_t i = 0; i < express_points; ++i) {
    const std::size_t cabin = 4 + (i / 2) * 5;
    const auto word = number_at<std::uint16_t>(bytes, cabin + 2 * (i % 2));
    const unsigned low = i % 2 == 0 ? bytes[cabin + 4] & 0x0FU : bytes[cabin + 4] >> 4U;
    capsule.distance_mm[i] = static_cast<std::uint16_t>(word >> 2U);
    capsule.back_q3[i] = static_cast<std::uint8_t>(low | ((word & 3U) << 4U));
  }
  return capsule;
}

Bytes encode(const HqFrame& frame) {
  Bytes bytes{start_byte};
  append_number(bytes, frame.time_us);
  for (const HqPoint& point : frame.points) {
    append_number(bytes, point.angle_q14);
    append_number(bytes, point.distance_q2);
    bytes.push_back(point.quality);
    bytes.push_back(point.begins_turn ? 1 : 0);
  }
  bytes.resize(hq_size - 4);
  const std::uint32_t checksum = checksum_of_hq(bytes);
  append_number(bytes, checksum);
  return bytes;
}

std::optional<HqFrame> decode_hq(ByteView bytes) {
  if (bytes.size() != hq_size || bytes[0] != start_byte) return std::nullopt;
  if (number_at<std::uint32_t>(bytes, hq_size - 4) != checksum_of_hq(bytes)) return std::nullopt;
  HqFrame frame;
  frame.time_us = number_at<std::uint64_t>(bytes, 1);
  for (std::size_t i = 0; i < hq_points; ++i) {
    const std::size_t at = 9 + 8 * i;
    frame.points[i] = {number_at<std::uint16_t>(bytes, at), number_at<std::uint32_t>(bytes, at + 2),
                       bytes[at + 6], (bytes[at + 7] & 1U) != 0};
  }
  return frame;
}

}  // namespace lodestar::rplidar
