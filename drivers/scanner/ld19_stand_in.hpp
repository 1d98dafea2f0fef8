#pragma once

#include "drivers/scanner/ld19_wire.hpp"
#include "drivers/scanner/scanner_stand_in.hpp"

namespace lodestar {

/// An LD19 at 10 turns of 450 beams a second.
class Ld19StandIn final : public ScannerStandIn {
 public:
  [[nodiscard]] BeamPattern pattern() const override;
  Bytes answer(ByteView /*request*/, Stamp /*now*/) override { return {}; }
  std::vector<TimedBytes> packets_of(const Scan& turn) override;
  void forget_client() override { waiting_.clear(); }

 private:
  std::vector<Beam> waiting_;  ///< not yet enough for a packet
};

}  // namespace lodestar
