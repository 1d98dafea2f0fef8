#pragma once

#include <deque>

#include "drivers/scanner/nanoscan_wire.hpp"
#include "drivers/scanner/scanner_protocol.hpp"
#include "drivers/scanner/turn_assembler.hpp"
#include "drivers/system/device_clock.hpp"

namespace lodestar {

/// SICK's nanoScan3 and microScan3, which send to the address that was set in their configuration (Safety
/// Designer, "data output"). They only talk.
class NanoscanProtocol final : public ScannerProtocol {
 public:
  /// Nearer than 0.05 m is the device's blind zone; 40 m is its measuring range (nanoScan3 data sheet).
  static constexpr RangeLimits nanoscan_limits{.min_range_m = 0.05, .max_range_m = 40.0};

  explicit NanoscanProtocol(const RangeLimits& limits = nanoscan_limits);

  void connect(Stamp now) override;
  void take(ByteView datagram, Stamp arrival) override;
  std::optional<Scan> next() override { return scans_.next(); }
  [[nodiscard]] std::string description() const override;
  [[nodiscard]] ProtocolCounts counts() const override { return counts_; }

 private:
  /// A telegram of which fragments are missing.
  struct Partial {
    std::uint32_t identification = 0;
    Bytes bytes;
    std::vector<bool> known;
    std::size_t missing = 0;
  };

  Partial& partial_of(const nanoscan::Fragment& fragment);
  bool take_telegram(const nanoscan::Telegram& telegram, Stamp arrival);

  std::deque<Partial> partials_;
  TurnAssembler scans_;
  DeviceClock clock_;
  Duration scan_time_{};
  ProtocolCounts counts_;
  std::uint32_t serial_number_ = 0;
  bool window_is_dirty_ = false;
};

}  // namespace lodestar
