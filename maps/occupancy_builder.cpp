#include "maps/occupancy_builder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "maps/grid_walk.hpp"

namespace lodestar {
namespace {

constexpr double far_cells = 1e8;  ///< fits into an int, and no room is as large

bool is_within_reach(const Vec2& point_in_grid) {
  return point_in_grid.cwiseAbs().maxCoeff() < far_cells;  // false for what is no number
}

/// A span of cells and some more on either side, so that the grid seldom grows.
std::pair<int, int> grown(int low, int high, int old_low, int old_high) {
  constexpr int spare = 64;
  return {low < old_low ? low - spare : old_low, high > old_high ? high + spare : old_high};
}

}  // namespace

std::size_t OccupancyBuilder::index(Cell cell) const {
  return static_cast<std::size_t>(cell.row - low_.row) * static_cast<std::size_t>(columns_) +
         static_cast<std::size_t>(cell.column - low_.column);
}

bool OccupancyBuilder::add(const Scan& scan, std::span<const Pose2> map_from_scanner) {
  rays_.clear();
  if (!reach(scan, map_from_scanner)) return false;
  ++scans_;
  for (const Ray& ray : rays_) cast(ray);
  commit();
  return true;
}

/// Lists the rays of a scan and makes the grid large enough for them.
bool OccupancyBuilder::reach(const Scan& scan, std::span<const Pose2> map_from_scanner) {
  const std::size_t beams = std::min(scan.beams.size(), map_from_scanner.size());
  Vec2 low = Vec2::Constant(std::numeric_limits<double>::infinity());
  Vec2 high = -low;
  for (std::size_t i = 0; i < beams; ++i) {
    const Beam& beam = scan.beams[i];
    const bool is_hit = beam.echo == Echo::hit;
    if (!is_hit && beam.echo != Echo::nothing) continue;
    const double reach_m = is_hit ? beam.range_m : std::min(scan.max_range_m, options_.clears_without_echo_m);
    const double clear_m = std::min(reach_m, options_.max_range_m);
    const double heading_rad = map_from_scanner[i].yaw_rad + beam.angle_rad;
    const Vec2 direction = Vec2(std::cos(heading_rad), std::sin(heading_rad)) / options_.resolution_m;
    const Vec2 from = map_from_scanner[i].position_m / options_.resolution_m;
    const Ray ray{.from_in_grid = from,
                  .clear_to_in_grid = from + clear_m * direction,
                  .end_in_grid = from + (clear_m + options_.depth_cells * options_.resolution_m) * direction,
                  .ends = is_hit && beam.range_m <= options_.max_range_m};
    if (!is_within_reach(from) || !is_within_reach(ray.end_in_grid)) return false;
    low = low.cwiseMin(from).cwiseMin(ray.end_in_grid);
    high = high.cwiseMax(from).cwiseMax(ray.end_in_grid);
    rays_.push_back(ray);
  }
  if (rays_.empty()) return true;
  const Cell first = cell_at(low);
  const Cell last = cell_at(high);
  const bool is_new = columns_ == 0;
  const auto [low_column, high_column] = grown(first.column, last.column, is_new ? first.column : low_.column,
                                               is_new ? last.column : low_.column + columns_ - 1);
  const auto [low_row, high_row] =
      grown(first.row, last.row, is_new ? first.row : low_.row, is_new ? last.row : low_.row + rows_ - 1);
  const int columns = high_column - low_column + 1;
  const int rows = high_row - low_row + 1;
  if (columns == columns_ && rows == rows_) return true;
  if (static_cast<double>(columns) * rows > static_cast<double>(options_.most_cells)) return false;

  const auto cells = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  std::vector<float> log_odds(cells, 0.0F);
  for (int row = 0; row < rows_; ++row) {
    const auto from = log_odds_.begin() + static_cast<std::ptrdiff_t>(row) * columns_;
    const std::ptrdiff_t to =
        static_cast<std::ptrdiff_t>(low_.row + row - low_row) * columns + low_.column - low_column;
    std::copy(from, from + columns_, log_odds.begin() + to);
  }
  log_odds_ = std::move(log_odds);
  evidence_.assign(cells, {});
  low_ = {low_column, low_row};
  columns_ = columns;
  rows_ = rows;
  return true;
}

OccupancyBuilder::Evidence& OccupancyBuilder::evidence(Cell cell) {
  const std::size_t at = index(cell);
  Evidence& known = evidence_[at];
  if (known.scan != scans_) {
    known = {.scan = scans_};
    touched_.push_back(at);
  }
  return known;
}

void OccupancyBuilder::cast(const Ray& ray) {
  constexpr auto most = std::numeric_limits<std::uint16_t>::max();
  const Cell end = cell_at(ray.end_in_grid);
  walk_grid(ray.from_in_grid, ray.clear_to_in_grid, [&](Cell cell, double, double) {
    if (ray.ends && cell == end) return false;
    Evidence& here = evidence(cell);
    here.misses = static_cast<std::uint16_t>(std::min<int>(here.misses + 1, most));
    return true;
  });
  if (!ray.ends) return;
  Evidence& here = evidence(end);
  here.hits = static_cast<std::uint16_t>(std::min<int>(here.hits + 1, most));
}

/// The beams of a scan in one cell together say no more than one of them.
void OccupancyBuilder::commit() {
  const double most = options_.most_log_odds;
  for (const std::size_t at : touched_) {
    const Evidence& here = evidence_[at];
    const double said = here.hits * options_.hit_log_odds + here.misses * options_.miss_log_odds;
    const double change = std::clamp(said, options_.miss_log_odds, options_.hit_log_odds);
    log_odds_[at] = static_cast<float>(std::clamp(log_odds_[at] + change, -most, most));
  }
  touched_.clear();
}

OccupancyMap OccupancyBuilder::map() const {
  Cell first{std::numeric_limits<int>::max(), std::numeric_limits<int>::max()};
  Cell last{std::numeric_limits<int>::min(), std::numeric_limits<int>::min()};
  for (int row = low_.row; row < low_.row + rows_; ++row) {
    for (int column = low_.column; column < low_.column + columns_; ++column) {
      if (log_odds_[index({column, row})] == 0.0F) continue;
      first = {std::min(first.column, column), std::min(first.row, row)};
      last = {std::max(last.column, column), std::max(last.row, row)};
    }
  }
  OccupancyMap map{.resolution_m = options_.resolution_m};
  if (last.column < first.column) return map;
  map.columns = last.column - first.column + 1;
  map.rows = last.row - first.row + 1;
  map.map_from_grid.position_m = options_.resolution_m * Vec2(first.column, first.row);
  map.cells.reserve(static_cast<std::size_t>(map.columns) * static_cast<std::size_t>(map.rows));
  for (int row = first.row; row <= last.row; ++row) {
    for (int column = first.column; column <= last.column; ++column) {
      const double log_odds = log_odds_[index({column, row})];
      map.cells.push_back(log_odds >= options_.occupied_log_odds ? OccupancyMap::occupied
                          : log_odds <= options_.free_log_odds   ? OccupancyMap::free
                                                                 : OccupancyMap::unknown);
    }
  }
  return map;
}

}  // namespace lodestar
