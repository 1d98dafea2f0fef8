#pragma once

#include <optional>
#include <string>

#include "maps/scan.hpp"

namespace lodestar {

/// Source of scans: a device or the simulated world.
class Scanner {
 public:
  Scanner() = default;
  Scanner(const Scanner&) = delete;
  Scanner& operator=(const Scanner&) = delete;
  virtual ~Scanner() = default;

  /// The oldest complete scan not yet polled; empty when none has arrived. Never blocks.
  virtual std::optional<Scan> poll() = 0;

  /// Packets so far; none of what has no packets.
  [[nodiscard]] virtual ScanPackets packets() const { return {}; }

  /// What the device says about itself, in words; empty for what has none.
  [[nodiscard]] virtual std::string description() const { return {}; }
};

}  // namespace lodestar
