#pragma once

#include <string>

#include "drivers/scanner/scanner_stand_in.hpp"
#include "drivers/scanner/scip_wire.hpp"

namespace lodestar {

/// A Hokuyo UST-10LX: 40 turns a second, 1081 steps over 270 degrees. It serves MD and ME without end or for
/// a count of scans, of any steps; not clusters or skipped scans.
class ScipStandIn final : public ScannerStandIn {
 public:
  [[nodiscard]] BeamPattern pattern() const override;
  Bytes answer(ByteView request, Stamp now) override;
  std::vector<TimedBytes> packets_of(const Scan& turn) override;
  void forget_client() override;

 private:
  struct Order {
    std::string command;
    std::size_t first = 0;
    std::size_t last = 0;
    bool with_intensity = false;
    int left = 0;  ///< scans; 0: without end
  };

  std::string answer_line(const std::string& line, Stamp now);
  std::string take_order(const std::string& line);

  std::string line_;  ///< of the client, so far
  bool laser_is_on_ = false;
  std::optional<Order> order_;
};

}  // namespace lodestar
