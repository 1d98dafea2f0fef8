#include "drivers/scanner/rplidar_protocol.hpp"

#include <cmath>
#include <fmt/format.h>

namespace lodestar {
namespace {

using rplidar::Answer;
using rplidar::Capsule;
using rplidar::Command;
using rplidar::Setting;

/// After the order to stop the device still sends for a while (application notes: 1 ms; serial buffers more).
constexpr Duration quieting_time = std::chrono::milliseconds(50);
constexpr Duration answer_patience = std::chrono::milliseconds(500);
constexpr std::size_t longest_answer = 256;
/// A drift of several percent: the sample rate is nominal, and an A1's follows its resistor.
constexpr DeviceClockOptions rplidar_clock{.tick = std::chrono::nanoseconds(1), .max_drift = 0.2};

Bytes ask_setting(Setting setting, std::optional<std::uint16_t> mode) {
  rplidar::Request request{Command::configuration, {}};
  append_number(request.payload, static_cast<std::uint32_t>(setting));
  if (mode) append_number(request.payload, *mode);
  return rplidar::encode(request);
}

Bytes ask_express(std::uint16_t mode) {
  return rplidar::encode({Command::express_scan, {static_cast<std::uint8_t>(mode), 0, 0, 0, 0}});
}

bool is_known_mode(Answer kind) {
  return kind == Answer::express || kind == Answer::dense || kind == Answer::hq;
}

}  // namespace

RplidarProtocol::RplidarProtocol(const RangeLimits& limits) : turns_(limits), clock_(rplidar_clock) {}

void RplidarProtocol::connect(Stamp now) {
  stream_.clear();
  turns_ = TurnAssembler(turns_.limits());
  streaming_.reset();
  held_.reset();
  stage_ = Stage::quieting;
  asked_ = now;
  asks_now_ = true;
  unhealthy_ = mode_is_usable_ = false;
  model_.clear();
}

Bytes RplidarProtocol::question() const {
  switch (stage_) {
    case Stage::quieting:
      return rplidar::encode({unhealthy_ ? Command::reset : Command::stop, {}});
    case Stage::info:
      return rplidar::encode({Command::info, {}});
    case Stage::health:
      return rplidar::encode({Command::health, {}});
    case Stage::sample_rate:
      return rplidar::encode({Command::sample_rate, {}});
    case Stage::typical_mode:
      return ask_setting(Setting::typical_mode, std::nullopt);
    case Stage::answer_type:
      return ask_setting(Setting::answer_type, mode_);
    case Stage::mode_period:
      return ask_setting(Setting::us_per_sample, mode_);
    case Stage::scan:
      return mode_is_usable_ ? ask_express(mode_) : rplidar::encode({Command::scan, {}});
  }
  return {};
}

Bytes RplidarProtocol::step(Stamp now) {
  if (streaming_) return {};
  if (!asks_now_ && stage_ == Stage::quieting && now - asked_ >= quieting_time) {
    stream_.clear();
    stage_ = Stage::info;
    asks_now_ = true;
  }
  if (!asks_now_ && now - asked_ >= answer_patience) {
    // Old firmware does not know its modes: then it scans in the standard one. All else begins again.
    const bool asked_for_modes = stage_ == Stage::typical_mode || stage_ == Stage::answer_type ||
                                 stage_ == Stage::mode_period || stage_ == Stage::sample_rate;
    if (!asked_for_modes) mode_is_usable_ = false;
    stage_ = asked_for_modes ? Stage::scan : Stage::quieting;
    asks_now_ = true;
  }
  if (!asks_now_) return {};
  asks_now_ = false;
  asked_ = now;
  return question();
}

Bytes RplidarProtocol::farewell() const {
  return rplidar::encode({Command::stop, {}});
}

void RplidarProtocol::take(ByteView bytes, Stamp arrival) {
  stream_.append(bytes);
  while (const std::size_t used = take_front(stream_.front(), arrival)) stream_.drop(used);
}

std::size_t RplidarProtocol::take_front(ByteView front, Stamp arrival) {
  if (!streaming_) return take_answer(front);
  if (*streaming_ == Answer::nodes) return take_node(front, arrival);
  return *streaming_ == Answer::hq ? take_hq(front, arrival) : take_capsule(front, arrival);
}

std::size_t RplidarProtocol::take_answer(ByteView front) {
  if (front.empty()) return 0;
  const bool may_begin =
      front[0] == rplidar::start_byte && (front.size() == 1 || front[1] == rplidar::answer_byte);
  if (may_begin && front.size() < rplidar::descriptor_size) return 0;
  const auto descriptor =
      may_begin ? rplidar::decode_descriptor(front.first(rplidar::descriptor_size)) : std::nullopt;
  if (!descriptor || (!descriptor->is_stream && descriptor->size > longest_answer)) {
    ++counts_.skipped_bytes;
    return 1;
  }
  if (descriptor->is_stream) {
    begin_stream(descriptor->answer);
    return rplidar::descriptor_size;
  }
  const std::size_t whole = rplidar::descriptor_size + descriptor->size;
  if (front.size() < whole) return 0;
  ++counts_.frames;
  understand(descriptor->answer, front.subspan(rplidar::descriptor_size, descriptor->size));
  return whole;
}

void RplidarProtocol::begin_stream(Answer kind) {
  if (stage_ != Stage::scan) return;
  if (kind != Answer::nodes && !is_known_mode(kind)) return;
  streaming_ = kind;
  stream_begin_ = stream_.position() + rplidar::descriptor_size;
  if (kind != Answer::nodes) sample_period_ = express_period_;
  clock_ = DeviceClock(rplidar_clock);
  turns_.forget();
  held_.reset();
  last_deg_.reset();
}

void RplidarProtocol::understand(Answer answer, ByteView content) {
  asks_now_ = true;
  if (stage_ == Stage::info && answer == Answer::info && content.size() == 20) {
    model_ = fmt::format("RPLIDAR model {:02X}, firmware {}.{:02}", content[0], content[2], content[1]);
    stage_ = Stage::health;
  } else if (stage_ == Stage::health && answer == Answer::health && content.size() == 3) {
    constexpr std::uint8_t broken = 2;
    unhealthy_ = content[0] == broken;
    stage_ = unhealthy_ ? Stage::quieting : Stage::sample_rate;
  } else if (stage_ == Stage::sample_rate && answer == Answer::sample_rate && content.size() == 4) {
    const auto standard_us = number_at<std::uint16_t>(content, 0);
    const auto express_us = number_at<std::uint16_t>(content, 2);
    if (standard_us > 0) sample_period_ = std::chrono::microseconds(standard_us);
    if (express_us > 0) express_period_ = std::chrono::microseconds(express_us);
    stage_ = Stage::typical_mode;
  } else if (answer == Answer::configuration && content.size() >= 4) {
    understand_setting(content);
  } else {
    asks_now_ = false;
  }
}

void RplidarProtocol::understand_setting(ByteView content) {
  const auto setting = static_cast<Setting>(number_at<std::uint32_t>(content, 0));
  const ByteView value = content.subspan(4);
  if (stage_ == Stage::typical_mode && setting == Setting::typical_mode && value.size() >= 2) {
    mode_ = number_at<std::uint16_t>(value, 0);
    stage_ = Stage::answer_type;
  } else if (stage_ == Stage::answer_type && setting == Setting::answer_type && !value.empty()) {
    const auto kind = static_cast<Answer>(value[0]);
    mode_is_usable_ = is_known_mode(kind);
    stage_ = mode_is_usable_ ? Stage::mode_period : Stage::scan;
  } else if (stage_ == Stage::mode_period && setting == Setting::us_per_sample && value.size() >= 4) {
    const auto q8_us = number_at<std::uint32_t>(value, 0);
    if (q8_us > 0 && q8_us < 1U << 20U) express_period_ = from_seconds(q8_us / 256.0 * 1e-6);
    stage_ = Stage::scan;
  } else {
    asks_now_ = false;
  }
}

/// The device sends no times, but samples at a steady rate: its stream's bytes, also those that were damaged,
/// count them.
Stamp RplidarProtocol::stamp_of_frame(std::size_t points, std::size_t size, Stamp arrival) {
  const std::uint64_t bytes = stream_.position() - stream_begin_ + size;
  const auto period_ns = static_cast<std::uint64_t>(sample_period_.count());
  return clock_.stamp_of(bytes * points * period_ns / size, arrival);
}

std::size_t RplidarProtocol::take_node(ByteView front, Stamp arrival) {
  if (front.size() < rplidar::node_size) return 0;
  const std::optional<rplidar::Node> node = rplidar::decode_node(front.first(rplidar::node_size));
  if (!node) {
    ++counts_.skipped_bytes;
    return 1;
  }
  ++counts_.frames;
  if (node->begins_turn) turns_.begin_turn();
  last_deg_.reset();  // the node itself says where a turn begins
  constexpr double quarter_mm = 0.00025;
  add_point(node->angle_q6 / 64.0, node->distance_q2, quarter_mm,
            stamp_of_frame(1, rplidar::node_size, arrival), static_cast<float>(node->quality) / 63.0F);
  return rplidar::node_size;
}

std::size_t RplidarProtocol::take_hq(ByteView front, Stamp arrival) {
  if (front.size() < rplidar::hq_size) return 0;
  const std::optional<rplidar::HqFrame> frame = rplidar::decode_hq(front.first(rplidar::hq_size));
  if (!frame) {
    if (front[0] == rplidar::start_byte) ++counts_.checksum_errors;
    ++counts_.skipped_bytes;
    return 1;
  }
  ++counts_.frames;
  const Stamp end = stamp_of_frame(rplidar::hq_points, rplidar::hq_size, arrival);
  for (std::size_t i = 0; i < rplidar::hq_points; ++i) {
    const rplidar::HqPoint& point = frame->points[i];
    if (point.begins_turn) turns_.begin_turn();
    add_point(point.angle_q14 * 90.0 / 16384.0, point.distance_q2, 0.00025,
              end - sample_period_ * static_cast<int>(rplidar::hq_points - 1 - i),
              static_cast<float>(point.quality) / 255.0F);
  }
  return rplidar::hq_size;
}

std::size_t RplidarProtocol::take_capsule(ByteView front, Stamp arrival) {
  if (front.size() < rplidar::capsule_size) return 0;
  const std::optional<Capsule> capsule =
      rplidar::decode_capsule(front.first(rplidar::capsule_size), *streaming_);
  if (!capsule) {
    const bool may_begin = (front[0] & 0xF0U) == 0xA0U && (front[1] & 0xF0U) == 0x50U;
    if (may_begin) ++counts_.checksum_errors;
    ++counts_.skipped_bytes;
    held_.reset();  // the angle of its points would be wrong
    return 1;
  }
  ++counts_.frames;
  if (capsule->begins_stream) held_.reset();
  const std::size_t points = *streaming_ == Answer::dense ? rplidar::dense_points : rplidar::express_points;
  const Stamp end = stamp_of_frame(points, rplidar::capsule_size, arrival);
  if (held_) add_points(*held_, capsule->start_q6, held_end_);
  held_ = capsule;
  held_end_ = end;
  return rplidar::capsule_size;
}

void RplidarProtocol::add_points(const Capsule& capsule, std::uint16_t next_start_q6, Stamp end) {
  const bool is_dense = *streaming_ == Answer::dense;
  const std::size_t points = is_dense ? rplidar::dense_points : rplidar::express_points;
  const std::uint32_t span_q6 = (next_start_q6 + 2 * rplidar::turn_q6 - capsule.start_q6) % rplidar::turn_q6;
  const double step_deg = span_q6 / 64.0 / static_cast<double>(points);
  for (std::size_t i = 0; i < points; ++i) {
    const double swept_deg = capsule.start_q6 / 64.0 + step_deg * static_cast<double>(i);
    const double back_deg = is_dense ? 0.0 : capsule.back_q3[i] / 8.0;
    const double whole_turns = std::floor(swept_deg / 360.0);
    const double turned_deg = swept_deg - 360.0 * whole_turns;
    if (last_deg_ && turned_deg + 180.0 < *last_deg_) turns_.begin_turn();
    last_deg_ = turned_deg;
    add_point(swept_deg - back_deg, capsule.distance_mm[i], 0.001,
              end - sample_period_ * static_cast<int>(points - 1 - i), 0.0F);
  }
}

void RplidarProtocol::add_point(double clockwise_deg, std::uint32_t units, double unit_m, Stamp stamp,
                                float intensity) {
  Beam beam;
  beam.stamp = stamp;
  beam.angle_rad = angle_of_clockwise(clockwise_deg);
  set_range(beam, units, unit_m, turns_.limits());
  if (beam.echo == Echo::hit) beam.intensity = intensity;
  turns_.add(beam);
}

std::string RplidarProtocol::description() const {
  if (model_.empty()) return "RPLIDAR, silent so far";
  return model_ + (unhealthy_ ? ", reports an internal error" : "");
}

}  // namespace lodestar
