#pragma once

#include "drivers/scanner/byte_stream.hpp"
#include "drivers/scanner/rplidar_wire.hpp"
#include "drivers/scanner/scanner_protocol.hpp"
#include "drivers/scanner/turn_assembler.hpp"
#include "drivers/system/device_clock.hpp"

namespace lodestar {

/// Slamtec's RPLIDAR. It is asked what it is and how it is, then told to scan in the mode that it calls
/// typical, where that answers in express, dense or HQ frames, and else in the standard mode, which all know.
class RplidarProtocol final : public ScannerProtocol {
 public:
  /// RPLIDAR A1 to S2 data sheets: from 0.15 m; 40 m is the longest of them, and each says its own.
  static constexpr RangeLimits rplidar_limits{.min_range_m = 0.15, .max_range_m = 40.0};
  static constexpr unsigned baud = 115200;

  explicit RplidarProtocol(const RangeLimits& limits = rplidar_limits);

  void connect(Stamp now) override;
  Bytes step(Stamp now) override;
  [[nodiscard]] Bytes farewell() const override;
  void take(ByteView bytes, Stamp arrival) override;
  std::optional<Scan> next() override { return turns_.next(); }
  [[nodiscard]] std::string description() const override;
  [[nodiscard]] ProtocolCounts counts() const override { return counts_; }

 private:
  enum class Stage { quieting, info, health, sample_rate, typical_mode, answer_type, mode_period, scan };

  [[nodiscard]] Bytes question() const;
  std::size_t take_front(ByteView front, Stamp arrival);
  std::size_t take_answer(ByteView front);
  std::size_t take_node(ByteView front, Stamp arrival);
  std::size_t take_hq(ByteView front, Stamp arrival);
  std::size_t take_capsule(ByteView front, Stamp arrival);
  void understand(rplidar::Answer answer, ByteView content);
  void understand_setting(ByteView content);
  void begin_stream(rplidar::Answer kind);
  void add_points(const rplidar::Capsule& capsule, std::uint16_t next_start_q6, Stamp end);
  void add_point(double clockwise_deg, std::uint32_t units, double unit_m, Stamp stamp, float intensity);
  Stamp stamp_of_frame(std::size_t points, std::size_t size, Stamp arrival);

  ByteStream stream_;
  TurnAssembler turns_;
  DeviceClock clock_;
  ProtocolCounts counts_;
  Stage stage_ = Stage::quieting;
  Stamp asked_;
  bool asks_now_ = false;
  bool unhealthy_ = false;
  std::optional<rplidar::Answer> streaming_;
  std::uint64_t stream_begin_ = 0;
  Duration sample_period_ = std::chrono::microseconds(500);  ///< of the standard mode at 2000 a second
  Duration express_period_ = std::chrono::microseconds(250);
  std::uint16_t mode_ = 0;
  bool mode_is_usable_ = false;
  std::optional<rplidar::Capsule> held_;  ///< whose points wait for the next capsule
  Stamp held_end_;
  std::optional<double> last_deg_;
  std::string model_;
};

}  // namespace lodestar
