#include "localization/integrity/marker_trust.hpp"

#include <algorithm>
#include <cmath>

#include "localization/filter/belief.hpp"

namespace lodestar {
namespace {

/// Displacement of the marker from its registered pose, if the estimate is right.
Vec3 offset_of(const MarkerSighting& sighting) {
  const Pose2 map_from_surveyed = sighting.map_from_base_expected * inverse(sighting.map_from_base_by_marker);
  Vec3 offset;
  offset << map_from_surveyed * sighting.marker_in_map - sighting.marker_in_map,
      wrap_angle(map_from_surveyed.yaw_rad);
  return offset;
}

/// Appends the ID and removes its earlier occurrence.
void add_last(std::vector<int>& ids, int id) {
  std::erase(ids, id);
  ids.push_back(id);
}

}  // namespace

void MarkerTrust::add_contradiction(const MarkerSighting& sighting) {
  if (sighting.squared_distance <= gate_squared_distance()) return;
  if (witnesses_beside(sighting.id) < options_.witnesses) return;
  Suspect& suspect = suspects_[sighting.id];
  if (suspect.distrusted) return;
  ++suspect.open.count;
  suspect.open.offset_sum += offset_of(sighting);
}

void MarkerTrust::add_agreement(std::span<const int> ids) {
  for (const int id : ids) add_last(witnesses_, id);
  if (witnesses_.size() > options_.remembered_witnesses) {
    const auto forgotten =
        std::ssize(witnesses_) - static_cast<std::ptrdiff_t>(options_.remembered_witnesses);
    witnesses_.erase(witnesses_.begin(), witnesses_.begin() + forgotten);
  }
  for (auto& [id, suspect] : suspects_) {
    if (suspect.distrusted) continue;
    if (std::ranges::find(ids, id) != ids.end()) {
      suspect = {};
    } else {
      confirm(suspect, ids);
    }
  }
}

void MarkerTrust::confirm(Suspect& suspect, std::span<const int> ids) {
  if (suspect.open.count == 0) return;
  for (const int id : ids) add_last(suspect.confirmed_by, id);
  if (std::ssize(suspect.confirmed_by) < options_.witnesses) return;
  suspect.confirmed.count += suspect.open.count;
  suspect.confirmed.offset_sum += suspect.open.offset_sum;
  suspect.open = {};
  suspect.confirmed_by.clear();
  suspect.distrusted =
      suspect.confirmed.count >= options_.contradictions_to_distrust && is_elsewhere(suspect.confirmed);
}

void MarkerTrust::estimate_moved() {
  for (auto& [id, suspect] : suspects_) {
    suspect.open = {};
    suspect.confirmed_by.clear();
  }
  witnesses_.clear();
}

bool MarkerTrust::is_elsewhere(const Contradictions& contradictions) const {
  const Vec3 offset = contradictions.offset_sum / std::max(contradictions.count, 1);
  return offset.head<2>().norm() > options_.tolerated_offset_m ||
         std::abs(offset.z()) > options_.tolerated_turn_rad;
}

int MarkerTrust::witnesses_beside(int id) const {
  return static_cast<int>(std::ranges::count_if(witnesses_, [id](int other) { return other != id; }));
}

bool MarkerTrust::trusts(int id) const {
  const auto suspect = suspects_.find(id);
  return suspect == suspects_.end() || !suspect->second.distrusted;
}

std::vector<DistrustedMarker> MarkerTrust::distrusted() const {
  std::vector<DistrustedMarker> result;
  for (const auto& [id, suspect] : suspects_) {
    if (!suspect.distrusted) continue;
    const Vec3 offset = suspect.confirmed.offset_sum / suspect.confirmed.count;
    result.push_back(
        {.id = id, .offset_m = offset.head<2>(), .turn_rad = offset.z(), .fixes = suspect.confirmed.count});
  }
  return result;
}

}  // namespace lodestar
