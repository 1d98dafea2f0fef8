#include "app/placement/plausibility.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>

namespace lodestar {
namespace {

constexpr double least_above_camera_m = 0.2;  ///< nearer, no camera has a whole marker in its view
constexpr double highest_ceiling_m = 20.0;    ///< the tallest halls; a marker there has no pixel a dot
constexpr double step_of_a_ceiling_m = 1.0;   ///< what a lower ceiling next door may differ by
constexpr std::size_t neighbours = 5;         ///< a majority of them outvotes two wrong ones
constexpr double deep_inside_m = 0.5;         ///< markers hang over shelves, and these are less deep

RegistryIssue issue_of(const RegisteredMarker& marker, IssueKind kind, bool error, std::string words) {
  return {kind, error, {marker.id}, marker.line, std::move(words), {}};
}

/// The median height of the nearest others; nothing with fewer than three of them.
std::optional<double> height_around_m(const std::vector<Vec3>& centers, std::size_t of) {
  std::vector<std::pair<double, double>> others;  // squared distance and height
  for (std::size_t i = 0; i < centers.size(); ++i)
    if (i != of) others.emplace_back((centers[i] - centers[of]).head<2>().squaredNorm(), centers[i].z());
  if (others.size() < 3) return std::nullopt;
  const std::size_t count = std::min(neighbours, others.size());
  std::ranges::partial_sort(others, others.begin() + static_cast<std::ptrdiff_t>(count));
  others.resize(count);
  std::ranges::sort(others, {}, &std::pair<double, double>::second);
  return others[count / 2].second;
}

std::optional<RegistryIssue> height_issue(const RegisteredMarker& marker, double z_m,
                                          std::optional<double> around_m, const CoveredFloor& floor) {
  const double camera_m = floor.view.camera_height_m;
  if (z_m < camera_m + least_above_camera_m)
    return issue_of(
        marker, IssueKind::implausible_height, true,
        fmt::format("marker {} at z {:.2f} m: the camera looks up from {:.2f} m and cannot see it", marker.id,
                    z_m, camera_m));
  if (z_m > highest_ceiling_m)
    return issue_of(marker, IssueKind::implausible_height, false,
                    fmt::format("marker {} at z {:.2f} m: higher than any ceiling ({:.0f} m)", marker.id, z_m,
                                highest_ceiling_m));
  if (around_m && std::abs(z_m - *around_m) > step_of_a_ceiling_m)
    return issue_of(
        marker, IssueKind::implausible_height, false,
        fmt::format("marker {} at z {:.2f} m: those around hang at {:.2f} m", marker.id, z_m, *around_m));
  return std::nullopt;
}

bool is_built_at(const HeightBands& heights, std::size_t cell, double z_m) {
  const auto band = static_cast<int>(std::floor((z_m - heights.low_m) / heights.step_m));
  return band >= 0 && band < HeightBands::count &&
         (heights.cells[cell] >> static_cast<unsigned>(band) & 1U) != 0;
}

/// Is no free cell within deep_inside_m?
bool lies_deep(const OccupancyMap& map, Cell middle) {
  const int reach = static_cast<int>(std::ceil(deep_inside_m / map.resolution_m));
  for (int row = middle.row - reach; row <= middle.row + reach; ++row) {
    for (int column = middle.column - reach; column <= middle.column + reach; ++column) {
      const Cell cell{column, row};
      if (map.contains(cell) && is_drivable(map.at(cell))) return false;
    }
  }
  return true;
}

/// The ceiling itself is built: what touches it does not count, as in a line of sight.
bool is_inside_structure(const Vec3& center, const CoveredFloor& floor) {
  const Cell cell = floor.map.cell_at(center.head<2>());
  if (!floor.map.contains(cell)) return false;  // reported as outside the map
  if (!floor.heights) return lies_deep(floor.map, cell);
  return is_built_at(*floor.heights, floor.map.index(cell), center.z() - floor.heights->touch_m);
}

}  // namespace

std::vector<RegistryIssue> find_implausible(const MarkerRegistry& registry, const CoveredFloor& floor) {
  std::vector<RegistryIssue> issues;
  std::vector<Vec3> centers;
  for (const RegisteredMarker& marker : registry.markers) centers.push_back(center_in_map(registry, marker));
  for (std::size_t i = 0; i < centers.size(); ++i) {
    const RegisteredMarker& marker = registry.markers[i];
    const Vec2 place_m = centers[i].head<2>();
    if (auto issue = height_issue(marker, centers[i].z(), height_around_m(centers, i), floor))
      issues.push_back(std::move(*issue));
    if (is_inside_structure(centers[i], floor))
      issues.push_back(issue_of(marker, IssueKind::inside_structure, false,
                                fmt::format("marker {} at {:.2f}, {:.2f} m lies inside what is built there",
                                            marker.id, place_m.x(), place_m.y())));
    for (RegistryIssue& issue : issues)
      if (issue.places_m.empty()) issue.places_m = {place_m};
  }
  return issues;
}

}  // namespace lodestar
