#pragma once

#include <vector>

#include "drivers/scanner/bytes.hpp"
#include "maps/scan.hpp"

namespace lodestar {

/// The beams of one turn: equal steps, counter-clockwise positive.
struct BeamPattern {
  int beams = 0;
  double first_rad = 0.0;
  double step_rad = 0.0;
  Duration turn{};  ///< from a beam to the same one in the next turn
  Duration step{};  ///< between beams
  double min_range_m = 0.0;
  double max_range_m = 0.0;
};

/// Bytes that a device sends at a time.
struct TimedBytes {
  Stamp due;
  Bytes bytes;
};

/// A scanner's side of its protocol: answers clients as the device does, and writes given scans as its own.
class ScannerStandIn {
 public:
  ScannerStandIn() = default;
  ScannerStandIn(const ScannerStandIn&) = delete;
  ScannerStandIn& operator=(const ScannerStandIn&) = delete;
  virtual ~ScannerStandIn() = default;

  /// The beams that the device measures, in their order.
  [[nodiscard]] virtual BeamPattern pattern() const = 0;
  /// What the device answers to these bytes of a client.
  virtual Bytes answer(ByteView request, Stamp now) = 0;
  /// One turn of the pattern, as the device sends it; nothing while no client has asked for scans.
  virtual std::vector<TimedBytes> packets_of(const Scan& turn) = 0;
  /// The client is gone, or another one came.
  virtual void forget_client() {}
};

}  // namespace lodestar
