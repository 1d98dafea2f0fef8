#include "drivers/scanner/rplidar_stand_in.hpp"

#include <cmath>
#include <numbers>
#include <string_view>

#include "drivers/scanner/turn_assembler.hpp"

namespace lodestar {
namespace {

using rplidar::Answer;
using rplidar::Command;
using rplidar::Setting;

constexpr int rplidar_beams = 360;
constexpr Duration rplidar_turn = std::chrono::milliseconds(100);
constexpr double max_range_m = 12.0;
constexpr std::uint16_t modes = 4;

Answer answer_of_mode(std::uint16_t mode) {
  if (mode == 0) return Answer::nodes;
  if (mode == 3) return Answer::hq;
  return mode == 2 ? Answer::dense : Answer::express;
}

std::uint16_t angle_q6(const Beam& beam) {
  const auto q6 = static_cast<std::uint32_t>(std::lround(clockwise_deg(beam.angle_rad) * 64.0));
  return static_cast<std::uint16_t>(q6 % rplidar::turn_q6);
}

Bytes single(Answer answer, const Bytes& content) {
  Bytes bytes =
      rplidar::encode(rplidar::Descriptor{static_cast<std::uint32_t>(content.size()), false, answer});
  append(bytes, content);
  return bytes;
}

Bytes setting(ByteView payload, std::uint16_t typical) {
  Bytes content;
  content.reserve(32);
  append(content, payload.first(4));
  const std::uint16_t mode = payload.size() >= 6 ? number_at<std::uint16_t>(payload, 4) : typical;
  switch (static_cast<Setting>(number_at<std::uint32_t>(payload, 0))) {
    case Setting::mode_count:
      append_number(content, modes);
      break;
    case Setting::typical_mode:
      append_number(content, typical);
      break;
    case Setting::us_per_sample:
      append_number(content, static_cast<std::uint32_t>(
                                 std::lround(seconds(rplidar_turn) / rplidar_beams * 1e6 * 256.0)));
      break;
    case Setting::max_distance:
      append_number(content, static_cast<std::uint32_t>(std::lround(max_range_m * 256.0)));
      break;
    case Setting::answer_type:
      content.push_back(static_cast<std::uint8_t>(answer_of_mode(mode)));
      break;
    case Setting::mode_name: {
      const std::string_view name = mode == 0   ? "Standard"
                                    : mode == 1 ? "Express"
                                    : mode == 2 ? "Dense"
                                                : "HQ";
      for (const char letter : name) content.push_back(static_cast<std::uint8_t>(letter));
      content.push_back(0);
      break;
    }
  }
  return content;
}

}  // namespace

BeamPattern RplidarStandIn::pattern() const {
  // Half a step from zero: clients that sort by whole degrees find one beam in each.
  return {.beams = rplidar_beams,
          .first_rad = -std::numbers::pi / rplidar_beams,
          .step_rad = -2.0 * std::numbers::pi / rplidar_beams,
          .turn = rplidar_turn,
          .step = rplidar_turn / rplidar_beams,
          .min_range_m = 0.15,
          .max_range_m = max_range_m};
}

Bytes RplidarStandIn::answer(ByteView request, Stamp /*now*/) {
  requests_.append(request);
  Bytes answers;
  for (;;) {
    const rplidar::ReadRequest read = rplidar::read_request(requests_.front());
    requests_.drop(read.used);
    if (read.request) append(answers, answer_one(*read.request));
    if (read.used == 0) return answers;
  }
}

Bytes RplidarStandIn::answer_one(const rplidar::Request& request) {
  switch (request.command) {
    case Command::stop:
    case Command::reset:
      streaming_.reset();
      return {};
    case Command::info: {
      Bytes info{0x18, 29, 1, 7};  // an A1; firmware 1.29: the first that knows its modes is 1.24
      info.resize(20, 0x5E);
      return single(Answer::info, info);
    }
    case Command::health:
      return single(Answer::health, {0, 0, 0});
    case Command::sample_rate: {
      Bytes rates;
      const auto us = static_cast<std::uint16_t>(std::lround(seconds(rplidar_turn) / rplidar_beams * 1e6));
      append_number(rates, us);
      append_number(rates, us);
      return single(Answer::sample_rate, rates);
    }
    case Command::configuration:
      return request.payload.size() >= 4
                 ? single(Answer::configuration, setting(request.payload, typical_mode_))
                 : Bytes();
    case Command::motor_support:
      return single(Answer::motor_support, {1, 0, 0, 0});
    case Command::scan:
      return begin(Answer::nodes);
    case Command::express_scan:
      // Mode 0 is how clients older than the modes ask for express.
      return begin(request.payload.empty() || request.payload[0] == 0 ? Answer::express
                                                                      : answer_of_mode(request.payload[0]));
    case Command::motor_speed:
    case Command::motor_pwm:
      return {};
  }
  return {};
}

Bytes RplidarStandIn::begin(Answer kind) {
  streaming_ = kind;
  begins_stream_ = true;
  waiting_.clear();
  last_deg_ = 360.0;
  const std::size_t size = kind == Answer::nodes ? rplidar::node_size
                           : kind == Answer::hq  ? rplidar::hq_size
                                                 : rplidar::capsule_size;
  return rplidar::encode(rplidar::Descriptor{static_cast<std::uint32_t>(size), true, kind});
}

void RplidarStandIn::forget_client() {
  streaming_.reset();
  requests_.clear();
}

std::vector<TimedBytes> RplidarStandIn::packets_of(const Scan& turn) {
  if (!streaming_) return {};
  if (*streaming_ != Answer::nodes) {
    waiting_.insert(waiting_.end(), turn.beams.begin(), turn.beams.end());
    return *streaming_ == Answer::hq ? hq_frames() : capsules();
  }
  std::vector<TimedBytes> nodes;
  bool begins = true;
  for (const Beam& beam : turn.beams) {
    const auto quality = static_cast<std::uint8_t>(std::lround(beam.intensity * 63.0F));
    const rplidar::Node node{begins, quality, angle_q6(beam),
                             static_cast<std::uint16_t>(units_of(beam, 0.00025, 0xFFFF))};
    nodes.push_back({beam.stamp, rplidar::encode(node)});
    begins = false;
  }
  return nodes;
}

std::vector<TimedBytes> RplidarStandIn::hq_frames() {
  std::vector<TimedBytes> packets;
  std::size_t at = 0;
  for (; at + rplidar::hq_points <= waiting_.size(); at += rplidar::hq_points) {
    rplidar::HqFrame frame;
    const Stamp end = waiting_[at + rplidar::hq_points - 1].stamp;
    frame.time_us = static_cast<std::uint64_t>(end.time_since_epoch() / std::chrono::microseconds(1));
    for (std::size_t i = 0; i < rplidar::hq_points; ++i) {
      const Beam& beam = waiting_[at + i];
      const double clockwise = clockwise_deg(beam.angle_rad);
      frame.points[i] = {static_cast<std::uint16_t>(std::lround(clockwise * 16384.0 / 90.0)),
                         units_of(beam, 0.00025, 0xFFFFFFFF),
                         static_cast<std::uint8_t>(std::lround(beam.intensity * 255.0F)),
                         clockwise < last_deg_};
      last_deg_ = clockwise;
    }
    packets.push_back({end, rplidar::encode(frame)});
  }
  waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(at));
  return packets;
}

std::vector<TimedBytes> RplidarStandIn::capsules() {
  const bool is_dense = *streaming_ == Answer::dense;
  const std::size_t points = is_dense ? rplidar::dense_points : rplidar::express_points;
  const std::uint32_t most_mm = is_dense ? 0xFFFF : 0x3FFF;
  std::vector<TimedBytes> packets;
  std::size_t at = 0;
  for (; at + points <= waiting_.size(); at += points) {
    rplidar::Capsule capsule{.begins_stream = begins_stream_, .start_q6 = angle_q6(waiting_[at])};
    begins_stream_ = false;
    for (std::size_t i = 0; i < points; ++i)
      capsule.distance_mm[i] = static_cast<std::uint16_t>(units_of(waiting_[at + i], 0.001, most_mm));
    packets.push_back({waiting_[at + points - 1].stamp,
                       is_dense ? rplidar::encode_dense(capsule) : rplidar::encode_express(capsule)});
  }
  waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(at));
  return packets;
}

}  // namespace lodestar
