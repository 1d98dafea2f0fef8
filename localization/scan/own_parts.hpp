#pragma once

#include <vector>

#include "localization/scan/own_outline.hpp"
#include "maps/scan.hpp"

namespace lodestar {

struct OwnPartsOptions {
  double bin_rad = radians(2.0);
  int learning_scans = 10;  ///< a second at 10 Hz
  double seen_share = 0.8;  ///< of the scans while it learns
  int gone_after = 5;       ///< scans in a row: what is gone was no part of the robot
};

/// The directions in which the scanner sees the robot itself: posts, cables, its own housing. Learned from
/// the first scans. A hit within the outline elsewhere is somebody who touches the robot.
class OwnParts {
 public:
  explicit OwnParts(const OwnPartsOptions& options = {});

  /// In the order of time, before the scan is used.
  void add(const Scan& scan, const ScannerMount& mount, const OwnOutline& outline);

  [[nodiscard]] bool has(double angle_rad) const;

 private:
  struct Bin {
    int seen = 0;  ///< while it learns
    bool is_own = false;
    int missing = 0;  ///< scans in a row
  };

  [[nodiscard]] std::size_t bin_of(double angle_rad) const;

  OwnPartsOptions options_;
  int scans_ = 0;
  std::vector<Bin> bins_;
};

}  // namespace lodestar
