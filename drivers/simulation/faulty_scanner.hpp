#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "drivers/simulation/fault.hpp"
#include "drivers/simulation/simulated_scanner.hpp"
#include "maps/random.hpp"

namespace lodestar {

/// The simulated scanner with faults of its motor, mount, window, clock and line. Without a fault it changes
/// nothing. Equal seeds and equal scans give equal faults.
class FaultyScanner final : public Scanner {
 public:
  /// As LDROBOT's scanners send them.
  static constexpr std::size_t beams_per_packet = 12;

  FaultyScanner(SimulatedScanner& scanner, std::uint64_t seed) : scanner_(scanner), seed_(seed) {}

  /// Sets the active faults; those that do not concern the scanner are ignored.
  void suffer(const std::vector<Fault>& active);
  void advance(Stamp now) { now_ = now; }

  std::optional<Scan> poll() override;
  [[nodiscard]] ScanPackets packets() const override { return packets_; }
  [[nodiscard]] std::string description() const override { return scanner_.description(); }

 private:
  struct Waiting {
    Stamp arrival;
    Scan scan;
  };

  /// Empty when nothing of the scan gets through.
  [[nodiscard]] std::optional<Waiting> spoiled(Scan scan);
  void lose_packets(Scan& scan, double share, const Random& random);

  SimulatedScanner& scanner_;
  std::uint64_t seed_;
  std::vector<Fault> active_;
  Stamp now_;
  std::optional<Stamp> clock_since_;  ///< when the clock became a foreign one
  std::optional<Scan> last_;          ///< as delivered
  std::deque<Waiting> waiting_;       ///< in the order of their measurement
  ScanPackets packets_;
};

}  // namespace lodestar
