#include "localization/filter/belief_offsets.hpp"

#include <algorithm>

#include "localization/filter/belief_pose.hpp"

namespace lodestar {
namespace {

constexpr Eigen::Index per_offset = Belief::states_of_offset;

constexpr Eigen::Index state_of(std::size_t offset) {
  return Belief::own_states + static_cast<Eigen::Index>(offset) * per_offset;
}

std::size_t index_of(const Belief& belief, int id) {
  return static_cast<std::size_t>(std::ranges::find(belief.offsets, id, &RecentOffset::id) -
                                  belief.offsets.begin());
}

/// Marginalized: what the other states know by it stays in their covariance.
void forget(std::size_t offset, Belief& belief) {
  const Eigen::Index size = belief.mean.size();
  const Eigen::Index at = state_of(offset);
  const Eigen::Index behind = size - at - per_offset;
  const Belief before = belief;
  belief.offsets.erase(belief.offsets.begin() + static_cast<std::ptrdiff_t>(offset));
  belief.mean.resize(size - per_offset);
  belief.mean << before.mean.head(at), before.mean.tail(behind);
  belief.covariance.resize(size - per_offset, size - per_offset);
  belief.covariance << before.covariance.topLeftCorner(at, at), before.covariance.topRightCorner(at, behind),
      before.covariance.bottomLeftCorner(behind, at), before.covariance.bottomRightCorner(behind, behind);
}

/// Those of the registry's sigmas; the others are of tilts.
constexpr Eigen::Index registered_states = 3;

/// In its sigmas: independent of all that is known.
void add(int id, Belief& belief) {
  const Eigen::Index size = belief.mean.size();
  const Belief before = belief;
  belief.offsets.push_back({id, belief.travel.stamp});
  belief.mean.setZero(size + per_offset);
  belief.mean.head(size) = before.mean;
  belief.covariance.setIdentity(size + per_offset, size + per_offset);
  belief.covariance.topLeftCorner(size, size) = before.covariance;
  belief.covariance.diagonal().segment<registered_states>(size).setConstant(belief.registry_variance);
}

}  // namespace

void remember_offsets(const PlanarFix& fix, Belief& belief) {
  const auto is_known = [&](std::size_t index) { return index < belief.offsets.size(); };
  for (const PlanarByOffset& by_offset : fix.by_offsets) {
    const std::size_t index = index_of(belief, by_offset.id);
    if (is_known(index)) belief.offsets[index].used = belief.travel.stamp;
  }
  for (const PlanarByOffset& by_offset : fix.by_offsets) {
    if (is_known(index_of(belief, by_offset.id))) continue;
    if (belief.offsets.size() == Belief::most_offsets) {
      const auto oldest = std::ranges::min_element(belief.offsets, {}, &RecentOffset::used);
      forget(static_cast<std::size_t>(oldest - belief.offsets.begin()), belief);
    }
    add(by_offset.id, belief);
  }
}

/// Between two priors of a state lies an observation of zero, whose variance is negative where knowledge is
/// taken back: 1/after = 1/before + 1/noise.
Belief with_registry_variance(const Belief& belief, double variance) {
  Belief result = belief;
  const double before = belief.registry_variance;
  result.registry_variance = variance;
  if (variance == before) return result;
  const double noise = before * variance / (before - variance);
  for (std::size_t offset = 0; offset < belief.offsets.size(); ++offset) {
    for (Eigen::Index i = 0; i < registered_states; ++i) {
      const Eigen::Index at = state_of(offset) + i;
      const Belief::State column = result.covariance.col(at);
      const double innovation_variance = column[at] + noise;
      result.mean -= column * (result.mean[at] / innovation_variance);
      result.covariance -= column * (column / innovation_variance).transpose();
    }
  }
  result.mean[2] = wrap_angle(result.mean[2]);
  return result;
}

Belief::ByState fix_by_state(const Belief& belief, const PlanarFix& fix) {
  Belief::ByState by_state = pose_by_state(belief);
  by_state.middleCols<3>(6).setIdentity();
  for (const PlanarByOffset& by_offset : fix.by_offsets) {
    by_state.middleCols<per_offset>(state_of(index_of(belief, by_offset.id))) = by_offset.jacobian;
  }
  return by_state;
}

}  // namespace lodestar
