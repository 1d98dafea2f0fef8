#include "app/placement/fill.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "maps/distance_field.hpp"
#include "maps/input_error.hpp"
#include "maps/marker.hpp"
#include "maps/marker_code.hpp"

namespace lodestar {
namespace {

/// Positions of the robot that see a marker at some place, as indices into the samples.
struct Candidate {
  Vec2 center_m = Vec2::Zero();
  std::vector<int> sees;
};

/// Where the robot can be, on a coarser grid; and how many markers each position still lacks.
struct Samples {
  std::vector<Vec2> places_m;
  std::vector<int> missing;
};

int stride_of(double step_m, const OccupancyMap& map) {
  return std::max(1, static_cast<int>(std::lround(step_m / map.resolution_m)));
}

Samples samples_of(const CoveredFloor& floor, const FillOptions& options) {
  const OccupancyMap& map = floor.map;
  const DistanceField distances(map);
  const int stride = stride_of(options.sample_m, map);
  Samples samples;
  for (int row = stride / 2; row < map.rows; row += stride)
    for (int column = stride / 2; column < map.columns; column += stride)
      if (distances.distance_m({column, row}) > floor.room_m)
        samples.places_m.push_back(map.center_of({column, row}));
  samples.missing.assign(samples.places_m.size(), options.wanted);
  return samples;
}

/// Whether no wall stands between two places. Without an OctoMap walls reach the ceiling.
bool is_in_sight(const OccupancyMap& map, const Vec2& from_m, const Vec2& to_m) {
  const auto steps = static_cast<int>(std::ceil((to_m - from_m).norm() / (0.5 * map.resolution_m)));
  for (int i = 0; i < steps; ++i) {
    const Cell cell = map.cell_at(from_m + (to_m - from_m) * (static_cast<double>(i) / steps));
    if (!map.contains(cell) || map.at(cell) >= 50) return false;
  }
  return true;
}

std::vector<int> seen_from(const Vec2& center_m, double height_m, const Samples& samples,
                           const CoveredFloor& floor) {
  const double reach_m = floor.view.reach_m(height_m);
  std::vector<int> sees;
  for (std::size_t i = 0; i < samples.places_m.size(); ++i) {
    const Vec2& at_m = samples.places_m[i];
    if ((at_m - center_m).squaredNorm() > reach_m * reach_m) continue;
    if (is_in_sight(floor.map, center_m, at_m)) sees.push_back(static_cast<int>(i));
  }
  return sees;
}

std::vector<Candidate> candidates_for(const Samples& samples, const CoveredFloor& floor,
                                      const FillOptions& options) {
  const OccupancyMap& map = floor.map;
  const int stride = stride_of(options.spacing_m, map);
  std::vector<Candidate> all;
  for (int row = stride / 2; row < map.rows; row += stride) {
    for (int column = stride / 2; column < map.columns; column += stride) {
      if (!is_drivable(map.at({column, row}))) continue;
      Candidate candidate{map.center_of({column, row}), {}};
      candidate.sees = seen_from(candidate.center_m, options.ceiling_m, samples, floor);
      if (!candidate.sees.empty()) all.push_back(std::move(candidate));
    }
  }
  return all;
}

void count(const std::vector<int>& sees, Samples& samples) {
  for (const int i : sees) --samples.missing[static_cast<std::size_t>(i)];
}

/// Centres of new markers, the most useful first.
std::vector<Vec2> chosen_centers(std::vector<Candidate> open, Samples& samples, std::vector<Vec2> taken_m,
                                 double apart_m) {
  const std::size_t present = taken_m.size();
  const auto gain_of = [&](const Candidate& candidate) {
    return std::ranges::count_if(candidate.sees,
                                 [&](int i) { return samples.missing[static_cast<std::size_t>(i)] > 0; });
  };
  for (;;) {
    std::erase_if(open, [&](const Candidate& candidate) {
      return std::ranges::any_of(
          taken_m, [&](const Vec2& at_m) { return (at_m - candidate.center_m).norm() < apart_m; });
    });
    const auto best = std::ranges::max_element(open, {}, gain_of);
    if (best == open.end() || gain_of(*best) == 0) break;
    count(best->sees, samples);
    taken_m.push_back(best->center_m);
  }
  return {taken_m.begin() + static_cast<std::ptrdiff_t>(present), taken_m.end()};
}

/// Throws InputError when there are fewer.
std::vector<int> ids_for(int wanted, const std::vector<int>& taken) {
  std::vector<int> ids = choose_marker_ids(wanted, taken);
  if (std::ssize(ids) >= wanted) return ids;
  throw InputError(
      fmt::format("found {} IDs that differ in two cells from those present, wanted {}", ids.size(), wanted));
}

/// From the centre of its square to O, of a marker without yaw on the map: its x is the map's x, its y points
/// to -90 degrees.
Vec2 center_to_o() {
  const double half_m = 0.5 * (marker_grid_size - 1) * marker_pitch_m;
  return {-half_m, half_m};
}

}  // namespace

Filling fill_gaps(const MarkerRegistry& registry, const CoveredFloor& floor, const FillOptions& options) {
  if (floor.view.reach_m(options.ceiling_m) <= 0.0)
    throw InputError(
        fmt::format("--ceiling: found {} m, wanted more: a camera at {} m sees no marker there at "
                    "every heading",
                    options.ceiling_m, floor.view.camera_height_m));
  Samples samples = samples_of(floor, options);
  std::vector<Vec2> taken_m;
  for (const RegisteredMarker& marker : registry.markers) {
    const Vec3 center = center_in_map(registry, marker);
    taken_m.emplace_back(center.head<2>());
    count(seen_from(taken_m.back(), center.z(), samples, floor), samples);
  }
  const std::vector<Vec2> centers_m =
      chosen_centers(candidates_for(samples, floor, options), samples, std::move(taken_m), options.apart_m);
  const std::vector<int> ids = ids_for(static_cast<int>(centers_m.size()), registered_ids(registry));
  const Pose2 registry_from_map = inverse(registry.map_from_registry);
  Filling filling;
  for (std::size_t i = 0; i < centers_m.size(); ++i) {
    const Vec2 o_m = registry_from_map * Vec2(centers_m[i] + center_to_o());
    filling.added.push_back({.id = ids[i],
                             .position_m = {o_m.x(), o_m.y(), options.ceiling_m},
                             .yaw_rad = registry_from_map.yaw_rad});
  }
  const double sample_m = stride_of(options.sample_m, floor.map) * floor.map.resolution_m;
  filling.uncovered_m2 =
      sample_m * sample_m *
      static_cast<double>(std::ranges::count_if(samples.missing, [](int missing) { return missing > 0; }));
  return filling;
}

}  // namespace lodestar
