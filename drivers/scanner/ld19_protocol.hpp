#pragma once

#include "drivers/scanner/byte_stream.hpp"
#include "drivers/scanner/ld19_wire.hpp"
#include "drivers/scanner/scanner_protocol.hpp"
#include "drivers/scanner/turn_assembler.hpp"
#include "drivers/system/device_clock.hpp"

namespace lodestar {

/// LDROBOT's LD06, LD19 and STL-19P: they talk from the moment they have power, and listen to nobody.
class Ld19Protocol final : public ScannerProtocol {
 public:
  /// LD19 data sheet: 0.02 to 12 m.
  static constexpr RangeLimits ld19_limits{.min_range_m = 0.02, .max_range_m = 12.0};
  static constexpr unsigned baud = 230400;

  explicit Ld19Protocol(const RangeLimits& limits = ld19_limits);

  void connect(Stamp now) override;
  void take(ByteView bytes, Stamp arrival) override;
  std::optional<Scan> next() override { return turns_.next(); }
  [[nodiscard]] std::string description() const override;
  [[nodiscard]] ProtocolCounts counts() const override { return counts_; }

 private:
  std::size_t take_front(ByteView front, Stamp arrival);
  bool take_packet(const ld19::Packet& packet, Stamp arrival);

  ByteStream stream_;
  TurnAssembler turns_;
  DeviceClock clock_;
  ProtocolCounts counts_;
  std::optional<std::uint32_t> last_cdeg_;
  std::optional<std::uint32_t> last_time_ms_;
  unsigned speed_degps_ = 0;
};

}  // namespace lodestar
