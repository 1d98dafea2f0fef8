#pragma once

#include <deque>

#include "drivers/scanner/byte_stream.hpp"
#include "drivers/scanner/rplidar_wire.hpp"
#include "drivers/scanner/scanner_stand_in.hpp"

namespace lodestar {

/// An RPLIDAR at 10 turns of 360 beams a second, with the modes 0 standard, 1 express, 2 dense and 3 HQ.
class RplidarStandIn final : public ScannerStandIn {
 public:
  explicit RplidarStandIn(std::uint16_t typical_mode = 1) : typical_mode_(typical_mode) {}

  [[nodiscard]] BeamPattern pattern() const override;
  Bytes answer(ByteView request, Stamp now) override;
  std::vector<TimedBytes> packets_of(const Scan& turn) override;
  void forget_client() override;

 private:
  Bytes answer_one(const rplidar::Request& request);
  Bytes begin(rplidar::Answer kind);
  std::vector<TimedBytes> capsules();
  std::vector<TimedBytes> hq_frames();

  std::uint16_t typical_mode_;
  ByteStream requests_;
  std::optional<rplidar::Answer> streaming_;
  bool begins_stream_ = false;
  double last_deg_ = 360.0;    ///< clockwise, of the last HQ point
  std::vector<Beam> waiting_;  ///< not yet enough for a capsule
};

}  // namespace lodestar
