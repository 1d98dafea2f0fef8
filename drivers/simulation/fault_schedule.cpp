#include "drivers/simulation/fault_schedule.hpp"

#include <algorithm>

#include "drivers/simulation/fault_table.hpp"
#include "maps/random.hpp"

namespace lodestar {
namespace {

std::optional<int> nearest_marker(const MarkerRegistry& registry, const Vec2& position_m) {
  const auto distance_m = [&](const RegisteredMarker& marker) {
    return (map_from_marker(registry, marker).translation().head<2>() - position_m).norm();
  };
  const auto nearest = std::ranges::min_element(registry.markers, {}, distance_m);
  return nearest == registry.markers.end() ? std::nullopt : std::optional(nearest->id);
}

bool affects_one_marker(const Fault& fault) {
  return fault.kind != FaultKind::markers_occluded &&
         fault_table()[static_cast<std::size_t>(fault.kind)].concerns_a_marker;
}

}  // namespace

FaultSchedule::FaultSchedule(std::vector<Fault> faults, std::uint64_t seed) {
  for (std::size_t i = 0; i < faults.size(); ++i) {
    const Fault& fault = faults[i];
    Duration begin = fault.begin;
    if (fault.latest_begin) {
      Random random = Random(seed).stream(i);
      begin = from_seconds(random.uniform(seconds(fault.begin), seconds(*fault.latest_begin)));
    }
    Entry entry{.fault = fault, .begin = Stamp(begin), .end = std::nullopt};
    if (fault.lasts) entry.end = entry.begin + *fault.lasts;
    entries_.push_back(entry);
  }
}

bool FaultSchedule::advance(Stamp now, const Vec2& position_m, const MarkerRegistry& registry) {
  bool changed = false;
  begun_.clear();
  for (Entry& entry : entries_) {
    if (!entry.has_begun && entry.begin <= now) {
      entry.has_begun = true;
      if (!entry.fault.marker && affects_one_marker(entry.fault))
        entry.fault.marker = nearest_marker(registry, position_m);
      begun_.push_back(entry.fault);
      changed = true;
    }
    if (entry.has_begun && !entry.has_ended && entry.end && *entry.end <= now) {
      entry.has_ended = true;
      changed = true;
    }
  }
  return changed;
}

std::vector<Fault> FaultSchedule::active() const {
  std::vector<Fault> active;
  for (const Entry& entry : entries_)
    if (entry.has_begun && !entry.has_ended) active.push_back(entry.fault);
  return active;
}

std::vector<FaultEvent> FaultSchedule::events() const {
  std::vector<FaultEvent> events;
  for (const Entry& entry : entries_) {
    if (!entry.has_begun) continue;
    events.push_back({.kind = entry.fault.kind,
                      .begin = entry.begin,
                      .end = entry.has_ended ? entry.end : std::nullopt,
                      .marker = entry.fault.marker});
  }
  return events;
}

}  // namespace lodestar
