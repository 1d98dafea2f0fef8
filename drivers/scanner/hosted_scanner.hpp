#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>

#include "drivers/scanner/scanner_stand_in.hpp"
#include "drivers/scanner/served_link.hpp"

namespace lodestar {

/// The distance to what stands at this angle of the scanner frame; nothing: free space.
using RangeOfAngle = std::function<std::optional<double>(double angle_rad)>;

/// One turn of a pattern, beginning at this time.
Scan measured_turn(const BeamPattern& pattern, Stamp begin, const RangeOfAngle& range_m);

/// A stand-in at a link, in real time: each packet is sent when the last beam in it was measured.
class HostedScanner {
 public:
  HostedScanner(std::unique_ptr<ScannerStandIn> stand_in, std::unique_ptr<ServedLink> link,
                RangeOfAngle range_m);

  /// Answers and sends what is due. To be called every few milliseconds; after a longer pause the turns that
  /// were missed are not made up for.
  void step(Stamp now);

 private:
  std::unique_ptr<ScannerStandIn> stand_in_;
  std::unique_ptr<ServedLink> link_;
  RangeOfAngle range_m_;
  Stamp next_turn_;
  std::deque<TimedBytes> due_;
};

/// Runs it until `stop` returns true.
void host(HostedScanner& scanner, const std::function<bool()>& stop);

}  // namespace lodestar
