#pragma once

#include "drivers/scanner/scanner_stand_in.hpp"

namespace lodestar {

/// A nanoScan3: 1651 beams over 275 degrees, 25 turns a second.
class NanoscanStandIn final : public ScannerStandIn {
 public:
  [[nodiscard]] BeamPattern pattern() const override;
  Bytes answer(ByteView /*request*/, Stamp /*now*/) override { return {}; }
  std::vector<TimedBytes> packets_of(const Scan& turn) override;

 private:
  std::uint32_t scans_ = 0;
};

}  // namespace lodestar
