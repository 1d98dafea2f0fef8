#pragma once

#include <functional>
#include <future>
#include <memory>

#include "drivers/scanner/byte_link.hpp"
#include "drivers/scanner/scanner.hpp"
#include "drivers/scanner/scanner_protocol.hpp"
#include "drivers/system/clock.hpp"

namespace lodestar {

struct ScannerDriverOptions {
  Duration retry_period = std::chrono::seconds(1);  ///< between two attempts to reopen it
  /// After which a connected scanner is reopened: its motor needs up to five seconds to its speed.
  Duration max_silence = std::chrono::seconds(6);
  std::function<Stamp()> now = monotonic_now;
};

/// A scanner that may be unplugged, hang, and come back: it is reopened in another thread, as resolving a
/// name or connecting takes longer than a moving robot may go without commands.
class ScannerDriver final : public Scanner {
 public:
  using Open = std::function<ByteLink()>;

  /// Opens it for the first time. Throws InputError when that fails: a scanner that is missing at the start
  /// is a configuration error, one that disappears later is a fault.
  ScannerDriver(Open open, std::unique_ptr<ScannerProtocol> protocol, ScannerDriverOptions options = {});
  ~ScannerDriver() override;

  std::optional<Scan> poll() override;
  [[nodiscard]] std::string description() const override { return protocol_->description(); }
  [[nodiscard]] ScanPackets packets() const override;
  [[nodiscard]] ProtocolCounts counts() const { return protocol_->counts(); }

 private:
  void read();
  void open_again();
  void take_opened();

  Open open_;
  std::unique_ptr<ScannerProtocol> protocol_;
  ScannerDriverOptions options_;
  std::unique_ptr<ByteLink> link_;
  Stamp heard_;  ///< arrival of the newest scan, or time of the last attempt to open
  std::future<std::unique_ptr<ByteLink>> opening_;
};

/// The scanner at an address: `ld19:/dev/ttyUSB0`, `rplidar:/dev/ttyUSB0[@BAUD]`, `scip:HOST[:PORT]`,
/// `scip:/dev/ttyACM0`, `nanoscan:PORT` (the UDP port that it sends to). Throws InputError for any other
/// address, and where there is no such device.
std::unique_ptr<Scanner> open_scanner(const std::string& address);

}  // namespace lodestar
