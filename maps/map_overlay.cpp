#include "maps/map_overlay.hpp"

#include <algorithm>
#include <cmath>

namespace lodestar {
namespace {

/// From a point in grid coordinates to the nearest occupied cell, a square, at most so many cells away.
bool is_occupied_within(const OccupancyMap& map, const Vec2& point_in_grid, double cells) {
  const Cell low = cell_at(point_in_grid.array() - cells);
  const Cell high = cell_at(point_in_grid.array() + cells);
  for (int row = std::max(low.row, 0); row <= std::min(high.row, map.rows - 1); ++row) {
    for (int column = std::max(low.column, 0); column <= std::min(high.column, map.columns - 1); ++column) {
      if (!is_wall(map.at({column, row}))) continue;
      const Vec2 nearest = point_in_grid.cwiseMax(Vec2(column, row)).cwiseMin(Vec2(column + 1, row + 1));
      if ((nearest - point_in_grid).norm() <= cells) return true;
    }
  }
  return false;
}

}  // namespace

OccupancyMap overlaid(OccupancyMap map, std::span<const Vec2> occupied_in_map) {
  for (const Vec2& point_in_map : occupied_in_map) {
    const Cell cell = map.cell_at(point_in_map);
    if (map.contains(cell)) map.cells[map.index(cell)] = OccupancyMap::occupied;
  }
  return map;
}

OccupancyMap split(const OccupancyMap& map, int parts) {
  if (parts == 1) return map;
  OccupancyMap result{.columns = map.columns * parts,
                      .rows = map.rows * parts,
                      .resolution_m = map.resolution_m / parts,
                      .map_from_grid = map.map_from_grid,
                      .cells = {}};
  result.cells.reserve(map.cells.size() * static_cast<std::size_t>(parts) * static_cast<std::size_t>(parts));
  for (int row = 0; row < result.rows; ++row)
    for (int column = 0; column < result.columns; ++column)
      result.cells.push_back(map.at({column / parts, row / parts}));
  return result;
}

MapExplanation::MapExplanation(const ObstacleField& field, const Eigen::Matrix3d& covariance,
                               const MapExplanationOptions& options)
    : field_(&field),
      options_(options),
      cells_from_map_(Eigen::Rotation2Dd(-field.map().map_from_grid.yaw_rad).toRotationMatrix() /
                      field.map().resolution_m),
      position_variance_m2_(square(larger_sigma(covariance.topLeftCorner<2, 2>()))),
      heading_variance_(std::max(covariance(2, 2), 0.0)) {}

bool MapExplanation::explains(const Vec2& hit_in_map, double range_m) const {
  const OccupancyMap& map = field_->map();
  const double sigma_m =
      std::sqrt(position_variance_m2_ + heading_variance_ * square(range_m) + square(options_.range_sigma_m));
  const double within_m = std::min(options_.sigmas * sigma_m + map.resolution_m, options_.most_m);
  const Vec2 hit_in_grid = cells_from_map_ * (hit_in_map - map.map_from_grid.position_m);
  const Cell cell = cell_at(hit_in_grid);
  if (!map.contains(cell)) return false;
  // The field measures between centres, and takes what is unknown for an obstacle: it only sorts out quickly.
  const double within_cells = within_m / map.resolution_m;
  if (field_->distance_cells(map.index(cell)) > within_cells + std::numbers::sqrt2) return false;
  return is_occupied_within(map, hit_in_grid, within_cells);
}

}  // namespace lodestar
