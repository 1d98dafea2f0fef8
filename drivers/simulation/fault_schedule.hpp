#pragma once

#include <cstdint>
#include <vector>

#include "drivers/simulation/fault.hpp"
#include "maps/geometry.hpp"
#include "maps/marker_registry.hpp"

namespace lodestar {

/// Which faults are on at a time, and which markers they befall.
class FaultSchedule {
 public:
  /// Draws the begins that are left open from the seed.
  FaultSchedule(std::vector<Fault> faults, std::uint64_t seed);

  /// True when a fault has begun or ended since the last call. `position_m` decides which marker is nearest.
  bool advance(Stamp now, const Vec2& position_m, const MarkerRegistry& registry);

  /// Those that are on now, with their markers filled in.
  [[nodiscard]] std::vector<Fault> active() const;

  /// Those that began with the last change.
  [[nodiscard]] const std::vector<Fault>& begun() const { return begun_; }

  /// All that have begun so far.
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
