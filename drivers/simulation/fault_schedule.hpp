#pragma once

#include <cstdint>
#include <vector>

#include "drivers/simulation/fault.hpp"
#include "maps/geometry.hpp"
#include "maps/marker_registry.hpp"

namespace lodestar {

/// The faults active at a time, and the markers that they affect.
class FaultSchedule {
 public:
  /// Draws begins that are given as intervals from the seed.
  FaultSchedule(std::vector<Fault> faults, std::uint64_t seed);

  /// True when a fault has begun or ended since the last call. `position_m` decides which marker is nearest.
  bool advance(Stamp now, const Vec2& position_m, const MarkerRegistry& registry);

  /// The active faults, with their markers filled in.
  [[nodiscard]] std::vector<Fault> active() const;

  /// The faults that began with the last change.
  [[nodiscard]] const std::vector<Fault>& begun() const { return begun_; }

  /// All faults that have begun so far.
  [[nodiscard]] std::vector<FaultEvent> events() const;

 private:
  struct Entry {
    Fault fault;
    Stamp begin;
    std::optional<Stamp> end;
    bool has_begun = false;
    bool has_ended = false;
  };

  std::vector<Entry> entries_;
  std::vector<Fault> begun_;
};

}  // namespace lodestar
