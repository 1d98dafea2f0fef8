#include "localization/integrity/scanner_mount_watch.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lodestar {
namespace {

/// From the middle of a cell to that of the nearest wall, in cells, at most `most`. To the field what is
/// unknown, and the end of the map, are obstacles; no beam ends there.
double cells_to_wall(const ObstacleField& field, Cell cell, double most) {
  const OccupancyMap& map = field.map();
  if (!map.contains(cell)) return most;
  const double least = field.distance_cells(map.index(cell));
  if (least >= most) return most;
  double nearest = most;
  const auto ask = [&](int aside, int up) {
    const Cell beside{cell.column + aside, cell.row + up};
    if (map.contains(beside) && is_wall(map.at(beside)))
      nearest = std::min(nearest, std::hypot(static_cast<double>(aside), static_cast<double>(up)));
  };
  // In growing squares, none of whose sides is nearer than `ring`.
  for (int ring = static_cast<int>(least / std::numbers::sqrt2); ring < nearest; ++ring) {
    for (int along = -ring; along <= ring; ++along) {
      ask(along, -ring);
      ask(along, ring);
      ask(-ring, along);
      ask(ring, along);
    }
  }
  return nearest;
}

}  // namespace

void ScannerMountWatch::add(const Scan& scan, std::span<const Pose2> map_from_scanner,
                            const ObstacleField& field) {
  const OccupancyMap& map = field.map();
  const std::size_t beams = std::min(scan.beams.size(), map_from_scanner.size());
  if (beams == 0) return;
  const Pose2& now = map_from_scanner.front();
  if (last_ && (now.position_m - last_->position_m).norm() < options_.between_m &&
      std::abs(wrap_angle(now.yaw_rad - last_->yaw_rad)) < options_.between_rad)
    return;
  last_ = now;

  std::array<double, 2 * steps + 1> cost{};
  std::array<double, 2 * steps + 1> explained{};
  std::size_t used = 0;
  const double most_off_cells = options_.most_off_m / map.resolution_m;
  constexpr std::size_t most_used = 120;  // are enough, and bound the time: 3000 look-ups
  const std::size_t stride = std::max<std::size_t>(1, beams / most_used);
  for (std::size_t i = 0; i < beams; i += stride) {
    const Beam& beam = scan.beams[i];
    if (beam.echo != Echo::hit) continue;
    ++used;
    for (std::size_t k = 0; k < cost.size(); ++k) {
      const double turn_rad = (static_cast<double>(k) - steps) * step_rad;
      const double heading_rad = map_from_scanner[i].yaw_rad + beam.angle_rad + turn_rad;
      const Vec2 end =
          map_from_scanner[i].position_m + beam.range_m * Vec2(std::cos(heading_rad), std::sin(heading_rad));
      const double off_m = map.resolution_m * cells_to_wall(field, map.cell_at(end), most_off_cells);
      cost[k] += square(off_m);
      explained[k] += off_m <= 1.5 * map.resolution_m ? 1.0 : 0.0;
    }
  }
  if (used == 0) return;
  if (sums_.empty() || sums_.back().scans >= options_.step) sums_.emplace_back();
  Sums& sums = sums_.back();
  for (std::size_t k = 0; k < cost.size(); ++k) {
    sums.cost[k] += cost[k] / static_cast<double>(used);
    sums.explained[k] += explained[k] / static_cast<double>(used);
  }
  if (++sums.scans >= options_.step) estimate();
}

/// The minimum of the parabola through the least cost and its neighbours.
void ScannerMountWatch::estimate() {
  Sums all;
  for (const Sums& sums : sums_) {
    for (std::size_t k = 0; k < all.cost.size(); ++k) {
      all.cost[k] += sums.cost[k];
      all.explained[k] += sums.explained[k];
    }
    all.scans += sums.scans;
  }
  if (all.scans < options_.scans) return;
  sums_.pop_front();
  const auto least = static_cast<std::size_t>(std::ranges::min_element(all.cost) - all.cost.begin());
  if (all.explained[least] < options_.least_explained * static_cast<double>(all.scans)) return;
  double steps_off = static_cast<double>(least) - steps;
  if (least > 0 && least + 1 < all.cost.size()) {
    const double bend = all.cost[least - 1] - 2.0 * all.cost[least] + all.cost[least + 1];
    if (bend > 0.0) steps_off += 0.5 * (all.cost[least - 1] - all.cost[least + 1]) / bend;
  }
  const double turned_rad = steps_off * step_rad;
  if (std::abs(turned_rad) <= options_.max_turn_rad)
    agreeing_ = 0;
  else
    agreeing_ = agreeing_ > 0 && turned_rad * *turned_rad_ > 0.0 ? agreeing_ + 1 : 1;
  turned_rad_ = turned_rad;
}

}  // namespace lodestar
