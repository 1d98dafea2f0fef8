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

void MarkerTrust::Contradictions::add(const Vec3& offset) {
  ++count;
  offset_sum += offset;
  square_sum += offset.cwiseAbs2();
}

void MarkerTrust::Contradictions::add(const Contradictions& more) {
  count += more.count;
  offset_sum += more.offset_sum;
  square_sum += more.square_sum;
}

/// The scatter of single contradictions: the estimate's error in them is shared, so their number does not
/// divide it. No less than what the other markers' places are known to.
Vec3 MarkerTrust::Contradictions::sigma() const {
  const Vec3 least(0.002, 0.002, radians(0.1));
  const Vec3 variance = square_sum / std::max(count, 1) - mean().cwiseAbs2();
  return variance.cwiseMax(least.cwiseAbs2()).cwiseSqrt();
}

void MarkerTrust::add_contradiction(const MarkerSighting& sighting) {
  if (sighting.squared_distance <= gate_squared_distance()) return;
  if (witnesses_beside(sighting.id) < options_.witnesses) return;
  Suspect& suspect = suspects_[sighting.id];
  if (suspect.distrusted) return;
  suspect.open.add(offset_of(sighting));
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
  suspect.confirmed.add(suspect.open);
  suspect.open = {};
  suspect.confirmed_by.clear();
  suspect.distrusted =
      suspect.confirmed.count >= options_.contradictions_to_distrust && is_elsewhere(suspect.confirmed);
}

void MarkerTrust::distrust(const DistrustedMarker& marker) {
  Suspect& suspect = suspects_[marker.id];
  suspect.distrusted = true;
  Vec3 offset;
  offset << marker.offset_m, marker.turn_rad;
  const Vec3 sigma(marker.sigma_m, marker.sigma_m, marker.sigma_rad);
  Contradictions& known = suspect.confirmed;
  known.count = std::max(marker.fixes, 1);
  known.offset_sum = known.count * offset;
  known.square_sum = known.count * (offset.cwiseAbs2() + sigma.cwiseAbs2());
}

void MarkerTrust::estimate_moved() {
  for (auto& [id, suspect] : suspects_) {
    suspect.open = {};
    suspect.confirmed_by.clear();
  }
  witnesses_.clear();
}

bool MarkerTrust::is_elsewhere(const Contradictions& contradictions) const {
  const Vec3 offset = contradictions.mean();
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
    const Vec3 offset = suspect.confirmed.mean();
    const Vec3 sigma = suspect.confirmed.sigma();
    result.push_back({.id = id,
                      .offset_m = offset.head<2>(),
                      .turn_rad = offset.z(),
                      .fixes = suspect.confirmed.count,
                      .sigma_m = sigma.head<2>().maxCoeff(),
                      .sigma_rad = sigma.z()});
  }
  return result;
}

}  // namespace lodestar
