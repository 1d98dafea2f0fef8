#include "drivers/scanner/scip_stand_in.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <utility>

#include "drivers/scanner/turn_assembler.hpp"
#include "maps/geometry.hpp"

namespace lodestar {
namespace {

/// As a UST-10LX answers, but for DMIN: it says 20 and measures from 60 (data sheet).
const scip::Parameters ust{.model = "UST-10LX(lodestar stand-in)",
                           .min_range_mm = 60,
                           .max_range_mm = 30000,
                           .steps_per_turn = 1440,
                           .first_step = 0,
                           .last_step = 1080,
                           .front_step = 540,
                           .turns_per_minute = 2400};
constexpr std::uint32_t out_of_range_mm = 65533;
constexpr std::uint32_t no_reading = 1;
constexpr std::uint32_t nearest_reading_mm = 20;
constexpr std::size_t longest_line = 64;

std::uint32_t range_mm(const Beam& beam) {
  switch (beam.echo) {
    case Echo::hit:
      return static_cast<std::uint32_t>(std::clamp(std::lround(beam.range_m * mm_per_m), 0L, 262143L));
    case Echo::nothing:
      return out_of_range_mm;
    case Echo::too_near:
      return nearest_reading_mm;
    case Echo::invalid:
      return no_reading;
  }
  return no_reading;
}

std::uint32_t time_ms(Stamp stamp) {
  const auto ms = std::chrono::floor<std::chrono::milliseconds>(stamp.time_since_epoch()).count();
  return static_cast<std::uint32_t>(ms) & 0xFFFFFFU;
}

std::string plain(const std::string& command, const std::string& status) {
  return scip::encode({command, status, {}});
}

}  // namespace

BeamPattern ScipStandIn::pattern() const {
  const double step_rad = 2.0 * std::numbers::pi / ust.steps_per_turn;
  const Duration turn = from_seconds(60.0 / ust.turns_per_minute);
  return {.beams = ust.last_step - ust.first_step + 1,
          .first_rad = (ust.first_step - ust.front_step) * step_rad,
          .step_rad = step_rad,
          .turn = turn,
          .step = turn / ust.steps_per_turn,
          .min_range_m = ust.min_range_mm / mm_per_m,
          .max_range_m = ust.max_range_mm / mm_per_m};
}

Bytes ScipStandIn::answer(ByteView request, Stamp now) {
  Bytes answers;
  for (const std::uint8_t byte : request) {
    if (byte != '\n' && byte != '\r') {
      if (line_.size() < longest_line) line_ += static_cast<char>(byte);
      continue;
    }
    if (line_.empty()) continue;
    const std::string text = answer_line(line_, now);
    answers.insert(answers.end(), text.begin(), text.end());
    line_.clear();
  }
  return answers;
}

std::string ScipStandIn::answer_line(const std::string& line, Stamp now) {
  const std::string name = line.substr(0, 2);
  if (name == "QT" || name == "RS") {
    order_.reset();
    laser_is_on_ = false;
    return plain(line, "00");
  }
  if (name == "BM") return plain(line, std::exchange(laser_is_on_, true) ? "02" : "00");
  if (name == "PP") return scip::encode({line, "00", scip::lines_of(ust)});
  if (name == "VV")
    return scip::encode(
        {line,
         "00",
         {"VEND:Lodestar;", "PROD:simulated scanner;", "FIRM:1.0;", "PROT:SCIP 2.0;", "SERI:H0000001;"}});
  if (name == "II")
    return scip::encode({line,
                         "00",
                         {fmt::format("MODL:{};", ust.model), laser_is_on_ ? "LASR:ON;" : "LASR:OFF;",
                          "SCSP:2400[rpm];", "MESM:Idle;", "SBPS:Ethernet 100 [Mbps];",
                          fmt::format("TIME:{:06X};", time_ms(now)), "STAT:Stable 000 no error.;"}});
  if (line == "TM1") return scip::encode_block(line, "00", scip::encode_number(time_ms(now), 4));
  if (line == "SCIP2.0" || name == "TM" || name == "HS" || name == "SS" || name == "CR")
    return plain(line, "00");
  if (name == "MD" || name == "ME") return take_order(line);
  return plain(line, "0E");  // no such command
}

/// MD or ME, first step (4 digits), last step (4), cluster (2), interval (1), scans (2).
std::string ScipStandIn::take_order(const std::string& line) {
  constexpr std::size_t length = 15;
  const bool is_number = line.size() == length && std::ranges::all_of(line.substr(2), [](char character) {
                           return std::isdigit(static_cast<unsigned char>(character)) != 0;
                         });
  if (!is_number) return plain(line, "01");
  const auto number = [&](std::size_t at, std::size_t digits) { return std::stoi(line.substr(at, digits)); };
  const int first = number(2, 4);
  const int last = number(6, 4);
  if (first > last || last > ust.last_step) return plain(line, "04");
  if (number(10, 2) > 1 || number(12, 1) > 0) return plain(line, "0E");
  laser_is_on_ = true;
  order_ = {line, static_cast<std::size_t>(first), static_cast<std::size_t>(last), line[1] == 'E',
            number(13, 2)};
  return plain(line, "00");
}

std::vector<TimedBytes> ScipStandIn::packets_of(const Scan& turn) {
  if (!order_ || order_->last >= turn.beams.size()) return {};
  const std::span beams = std::span(turn.beams).subspan(order_->first, order_->last - order_->first + 1);
  std::string data = scip::encode_number(time_ms(beams.front().stamp), scip::time_digits);
  for (const Beam& beam : beams) {
    data += scip::encode_number(range_mm(beam), scip::range_digits);
    if (!order_->with_intensity) continue;
    const auto intensity = static_cast<std::uint32_t>(std::lround(beam.intensity * 65535.0F));
    data += scip::encode_number(intensity, scip::range_digits);
  }
  std::string echo = order_->command;
  const bool is_counted = order_->left > 0;
  if (is_counted) echo.replace(13, 2, fmt::format("{:02}", --order_->left));
  const std::string text = scip::encode_block(echo, "99", data);
  const TimedBytes packet{beams.back().stamp, {text.begin(), text.end()}};
  if (is_counted && order_->left == 0) order_.reset();
  return {packet};
}

void ScipStandIn::forget_client() {
  order_.reset();
  line_.clear();
}

}  // namespace lodestar
