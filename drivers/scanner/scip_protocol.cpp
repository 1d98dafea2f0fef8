#include "drivers/scanner/scip_protocol.hpp"

#include <fmt/format.h>
#include <numbers>

#include "maps/geometry.hpp"

namespace lodestar {
namespace {

constexpr Duration scip_patience = std::chrono::seconds(1);  ///< then all begins again
constexpr std::size_t longest_answer_text = 1U << 17U;
constexpr DeviceClockOptions scip_clock{.ticks_to_wrap = 1U << 24U};
/// Smaller values are reasons for which a step has no range (URG-04LX communication protocol, table 1).
constexpr std::uint32_t reasons = 20;

Beam beam_of(std::uint32_t range_mm, const scip::Parameters& parameters) {
  Beam beam;
  if (range_mm < reasons) return beam;
  set_range(
      beam, range_mm, 0.001,
      {.min_range_m = parameters.min_range_mm / mm_per_m, .max_range_m = parameters.max_range_mm / mm_per_m});
  return beam;
}

}  // namespace

ScipProtocol::ScipProtocol() : scans_(RangeLimits{}), clock_(scip_clock) {}

void ScipProtocol::connect(Stamp now) {
  text_.clear();
  scans_ = TurnAssembler(RangeLimits{});
  clock_ = DeviceClock(scip_clock);
  stage_ = Stage::quiet;
  asks_now_ = true;
  asked_ = now;
  parameters_ = {};
}

std::string ScipProtocol::command() const {
  switch (stage_) {
    case Stage::quiet:
      return "QT";
    case Stage::parameters:
      return "PP";
    case Stage::laser:
      return "BM";
    case Stage::scan:
    case Stage::scanning:
      return scip::order_to_scan(parameters_);
  }
  return {};
}

Bytes ScipProtocol::step(Stamp now) {
  if (stage_ == Stage::scanning) return {};
  if (!asks_now_ && now - asked_ >= scip_patience) {
    stage_ = Stage::quiet;
    asks_now_ = true;
  }
  if (!asks_now_) return {};
  asks_now_ = false;
  asked_ = now;
  const std::string line = command() + '\n';
  return {line.begin(), line.end()};
}

Bytes ScipProtocol::farewell() const {
  return {'Q', 'T', '\n'};
}

void ScipProtocol::take(ByteView bytes, Stamp arrival) {
  for (const std::uint8_t byte : bytes) {
    const bool ends = byte == '\n' && !text_.empty() && text_.back() == '\n';
    if (ends) {
      take_answer(std::string_view(text_).substr(0, text_.size() - 1), arrival);
      text_.clear();
    } else if (byte != '\n' || !text_.empty()) {
      text_ += static_cast<char>(byte);
    }
    if (text_.size() <= longest_answer_text) continue;
    counts_.skipped_bytes += text_.size();
    text_.clear();
  }
}

void ScipProtocol::take_answer(std::string_view text, Stamp arrival) {
  const std::optional<scip::Answer> answer = scip::decode(text);
  if (!answer) {
    ++counts_.checksum_errors;
    return;
  }
  if (answer->command != command()) {  // of an earlier client, or late
    counts_.skipped_bytes += text.size();
    return;
  }
  ++counts_.frames;
  understand(*answer, arrival);
}

void ScipProtocol::understand(const scip::Answer& answer, Stamp arrival) {
  switch (stage_) {
    case Stage::quiet:
      stage_ = Stage::parameters;
      asks_now_ = true;
      return;
    case Stage::parameters:
      if (const auto found = scip::parameters_of(answer.lines)) {
        parameters_ = *found;
        stage_ = Stage::laser;
        asks_now_ = true;
      }
      return;
    case Stage::laser:
      if (answer.status != "00" && answer.status != "02") return;  // 02: it is on already
      stage_ = Stage::scan;
      asks_now_ = true;
      return;
    case Stage::scan:
      if (answer.status == "00" || answer.status == "99") stage_ = Stage::scanning;
      return;
    case Stage::scanning:
      if (answer.status == "99" && take_scan(answer, arrival)) return;
      --counts_.frames;
      ++counts_.checksum_errors;
      return;
  }
}

bool ScipProtocol::take_scan(const scip::Answer& answer, Stamp arrival) {
  const std::optional<std::string> data = scip::block_of(answer);
  const auto steps = static_cast<std::size_t>(parameters_.last_step - parameters_.first_step + 1);
  if (!data || data->size() != scip::time_digits + steps * scip::range_digits) return false;
  const std::string_view digits = *data;
  const auto time_ms = scip::decode_number(digits.substr(0, scip::time_digits));
  if (!time_ms) return false;

  const double turn_s = 60.0 / parameters_.turns_per_minute;
  const double step_s = turn_s / parameters_.steps_per_turn;
  const double step_rad = 2.0 * std::numbers::pi / parameters_.steps_per_turn;
  Scan scan{{}, parameters_.min_range_mm / mm_per_m, parameters_.max_range_mm / mm_per_m};
  scan.beams.reserve(steps);
  for (std::size_t i = 0; i < steps; ++i) {
    const auto range_mm =
        scip::decode_number(digits.substr(scip::time_digits + i * scip::range_digits, scip::range_digits));
    if (!range_mm) return false;
    Beam beam = beam_of(*range_mm, parameters_);
    beam.angle_rad =
        wrap_angle((parameters_.first_step + static_cast<int>(i) - parameters_.front_step) * step_rad);
    scan.beams.push_back(beam);
  }
  // The device's time is that of the first step; the answer is sent after the last one.
  const Duration sweep = from_seconds(step_s * static_cast<double>(steps - 1));
  const Stamp first = clock_.stamp_of(*time_ms, arrival - sweep);
  for (std::size_t i = 0; i < steps; ++i)
    scan.beams[i].stamp = first + from_seconds(step_s * static_cast<double>(i));
  scans_.add_scan(std::move(scan));
  return true;
}

std::string ScipProtocol::description() const {
  if (parameters_.steps_per_turn == 0) return "Hokuyo scanner, silent so far";
  return fmt::format("Hokuyo {}, {} steps, {:.1f} turns a second", parameters_.model,
                     parameters_.last_step - parameters_.first_step + 1, parameters_.turns_per_minute / 60.0);
}

}  // namespace lodestar
