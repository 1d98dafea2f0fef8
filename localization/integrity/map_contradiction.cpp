#include "localization/integrity/map_contradiction.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "maps/grid_walk.hpp"

namespace lodestar {
namespace {

/// Runs of angles, in a circle, that are apart by more than `between`, and have at least so many members.
int count_sectors(std::vector<double> angles_rad, double between_rad, int least) {
  if (angles_rad.empty()) return 0;
  std::ranges::sort(angles_rad);
  // Begin behind the widest gap, so that no run is cut in two at pi.
  std::size_t first = 0;
  double widest = angles_rad.front() + 2.0 * std::numbers::pi - angles_rad.back();
  for (std::size_t i = 1; i < angles_rad.size(); ++i) {
    if (angles_rad[i] - angles_rad[i - 1] <= widest) continue;
    widest = angles_rad[i] - angles_rad[i - 1];
    first = i;
  }
  std::ranges::rotate(angles_rad, angles_rad.begin() + static_cast<std::ptrdiff_t>(first));
  int sectors = 0;
  int members = 0;
  for (std::size_t i = 0; i < angles_rad.size(); ++i) {
    const bool begins = i == 0 || std::abs(wrap_angle(angles_rad[i] - angles_rad[i - 1])) > between_rad;
    members = begins ? 1 : members + 1;
    if (members == least) ++sectors;
  }
  return sectors;
}

}  // namespace

double wall_passed_m(const OccupancyMap& map, const Vec2& from_in_map, double heading_rad, double range_m,
                     double slack_m) {
  const double way_m = range_m - slack_m;
  if (!(way_m > 0.0) || map.resolution_m <= 0.0) return 0.0;
  const Pose2 grid_from_map = inverse(map.map_from_grid);
  const Vec2 to_in_map = from_in_map + way_m * Vec2(std::cos(heading_rad), std::sin(heading_rad));
  double passed_m = 0.0;
  walk_grid((grid_from_map * from_in_map) / map.resolution_m, (grid_from_map * to_in_map) / map.resolution_m,
            [&](Cell cell, double enters, double leaves) {
              if (map.contains(cell) && is_wall(map.at(cell))) passed_m += (leaves - enters) * way_m;
              return true;
            });
  return passed_m;
}

void MapContradiction::update(const Scan& scan, std::span<const Pose2> map_from_scanner,
                              const OccupancyMap& map, const PoseSigmas& sigmas) {
  std::vector<double> through_rad;
  const std::size_t beams = std::min(scan.beams.size(), map_from_scanner.size());
  for (std::size_t i = 0; i < beams; ++i) {
    const Beam& beam = scan.beams[i];
    if (beam.echo != Echo::hit) continue;
    const double sigma_m = std::sqrt(square(sigmas.range_m) + square(sigmas.position_m) +
                                     square(beam.range_m * sigmas.heading_rad));
    const double slack_m = options_.slack_m + options_.sigmas * sigma_m;
    const Pose2& pose = map_from_scanner[i];
    if (wall_passed_m(map, pose.position_m, pose.yaw_rad + beam.angle_rad, beam.range_m, slack_m) >
        options_.least_chord_m)
      through_rad.push_back(beam.angle_rad);
  }
  sectors_ = count_sectors(std::move(through_rad), options_.between_sectors_rad, options_.least_beams);
  contradicts_.push_back(sectors_ >= options_.least_sectors);
  if (contradicts_.size() > options_.scans) contradicts_.pop_front();
}

bool MapContradiction::alarm() const {
  return static_cast<std::size_t>(std::ranges::count(contradicts_, true)) >= options_.least_scans;
}

}  // namespace lodestar
