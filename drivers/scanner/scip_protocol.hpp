#pragma once

#include "drivers/scanner/scanner_protocol.hpp"
#include "drivers/scanner/scip_wire.hpp"
#include "drivers/scanner/turn_assembler.hpp"
#include "drivers/system/device_clock.hpp"

namespace lodestar {

/// Hokuyo's URG, UST and UTM: quieted, asked for its parameters, its laser switched on, told to scan.
class ScipProtocol final : public ScannerProtocol {
 public:
  static constexpr unsigned baud = 115200;
  static constexpr unsigned tcp_port = 10940;

  ScipProtocol();

  void connect(Stamp now) override;
  Bytes step(Stamp now) override;
  [[nodiscard]] Bytes farewell() const override;
  void take(ByteView bytes, Stamp arrival) override;
  std::optional<Scan> next() override { return scans_.next(); }
  [[nodiscard]] std::string description() const override;
  [[nodiscard]] ProtocolCounts counts() const override { return counts_; }

 private:
  enum class Stage { quiet, parameters, laser, scan, scanning };

  [[nodiscard]] std::string command() const;
  void take_answer(std::string_view text, Stamp arrival);
  void understand(const scip::Answer& answer, Stamp arrival);
  bool take_scan(const scip::Answer& answer, Stamp arrival);

  std::string text_;  ///< that has arrived, up to the empty line
  TurnAssembler scans_;
  DeviceClock clock_;
  ProtocolCounts counts_;
  Stage stage_ = Stage::quiet;
  bool asks_now_ = false;
  Stamp asked_;
  scip::Parameters parameters_;
};

}  // namespace lodestar
