#include "app/ros2/ros2_shapes.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <limits>

#include "app/recording/drive_moment.hpp"

namespace lodestar {
namespace {

using Level = DiagnosticLine::Level;

float range_of(const Beam& beam) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  switch (beam.echo) {
    case Echo::hit:
      return static_cast<float>(beam.range_m);
    case Echo::nothing:
      return infinity;
    case Echo::too_near:
      return -infinity;
    case Echo::invalid:
      break;
  }
  return std::numeric_limits<float>::quiet_NaN();
}

/// Were the beams measured in the order of their angles, counter-clockwise, but for one jump where a turn
/// ends?
bool turns_left(const std::vector<Beam>& beams) {
  std::size_t back = 0;
  for (std::size_t i = 1; i < beams.size(); ++i)
    if (beams[i].angle_rad < beams[i - 1].angle_rad) ++back;
  return back == 0;
}

double largest_sigma_m(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(covariance.topLeftCorner<2, 2>(),
                                                              Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(solver.eigenvalues()[1], 0.0));
}

DiagnosticLine localization_line(const Ros2Report& report) {
  DiagnosticLine line{.level = Level::error, .name = "lodestar: localization", .message = "no pose yet"};
  if (!report.estimate) return line;
  const PoseEstimate& estimate = *report.estimate;
  const double unseen_s = seconds(report.now - estimate.last_agreed);
  constexpr double long_s = 2.0;  // a marker passes every second or two where they hang as advised
  line.level = report.distrusted.empty() && unseen_s < long_s ? Level::ok : Level::warn;
  line.message = fmt::format("pose within {:.0f} mm, seen {:.1f} s ago",
                             mm_per_m * largest_sigma_m(estimate.covariance), unseen_s);
  line.values = {
      {"position sigma (mm)", fmt::format("{:.1f}", mm_per_m * largest_sigma_m(estimate.covariance))},
      {"yaw sigma (deg)",
       fmt::format("{:.3f}", degrees(std::sqrt(std::max(estimate.covariance(2, 2), 0.0))))},
      {"seconds since a fix", fmt::format("{:.2f}", seconds(report.now - estimate.last_fix))},
      {"markers of the newest fix", fmt::format("{}", fmt::join(report.markers, " "))},
      {"markers not trusted", fmt::format("{}", fmt::join(report.distrusted, " "))}};
  return line;
}

DiagnosticLine base_line(const Ros2Report& report) {
  const Level level = report.base == BaseState::ready   ? Level::ok
                      : report.base == BaseState::fault ? Level::error
                                                        : Level::warn;
  return {.level = level,
          .name = "lodestar: base",
          .message = in_words(report.base, report.fault, report.fault_details)};
}

DiagnosticLine motion_line(const Ros2Report& report) {
  const bool waits = report.path != nullptr;
  DiagnosticLine line{.name = "lodestar: motion", .message = waits ? "driving" : "no goal"};
  if (report.slowed_by) line.message = fmt::format("slowed: {}", to_string(*report.slowed_by));
  if (report.stop) line.message = fmt::format("must not move: {}", to_string(*report.stop));
  if (report.stop || report.slowed_by) line.level = Level::warn;
  return line;
}

}  // namespace

OccupancyMap axis_aligned(const OccupancyMap& map) {
  constexpr double parallel_rad = 1e-9;
  if (std::abs(map.map_from_grid.yaw_rad) < parallel_rad) return map;
  const double width_m = map.columns * map.resolution_m;
  const double height_m = map.rows * map.resolution_m;
  Vec2 low_m = map.map_from_grid.position_m;
  Vec2 high_m = low_m;
  for (const Vec2& corner : {Vec2(width_m, 0.0), Vec2(0.0, height_m), Vec2(width_m, height_m)}) {
    const Vec2 at = map.map_from_grid * corner;
    low_m = low_m.cwiseMin(at);
    high_m = high_m.cwiseMax(at);
  }
  const auto count = [&](double length_m) {
    constexpr double rounding = 1e-9;
    return static_cast<int>(std::ceil(length_m / map.resolution_m - rounding));
  };
  OccupancyMap aligned{.columns = count(high_m.x() - low_m.x()),
                       .rows = count(high_m.y() - low_m.y()),
                       .resolution_m = map.resolution_m,
                       .map_from_grid = {low_m, 0.0},
                       .cells = {}};
  aligned.cells.reserve(static_cast<std::size_t>(aligned.columns) * static_cast<std::size_t>(aligned.rows));
  for (int row = 0; row < aligned.rows; ++row) {
    for (int column = 0; column < aligned.columns; ++column) {
      const Cell there = map.cell_at(aligned.center_of({column, row}));
      aligned.cells.push_back(map.contains(there) ? map.at(there) : OccupancyMap::unknown);
    }
  }
  return aligned;
}

EvenScan even(const Scan& scan) {
  EvenScan even{.min_range_m = scan.min_range_m, .max_range_m = scan.max_range_m};
  if (scan.beams.empty()) return even;
  const auto [low, high] = std::ranges::minmax(scan.beams, {}, &Beam::angle_rad);
  const auto count = scan.beams.size();
  even.stamp = scan.beams.front().stamp;
  even.turn_s = seconds(scan.beams.back().stamp - scan.beams.front().stamp);
  even.first_rad = low.angle_rad;
  if (count > 1) {
    even.step_rad = (high.angle_rad - low.angle_rad) / static_cast<double>(count - 1);
    if (turns_left(scan.beams)) even.step_s = even.turn_s / static_cast<double>(count - 1);
  }
  even.ranges_m.assign(count, std::numeric_limits<float>::quiet_NaN());
  even.intensities.assign(count, 0.0F);
  for (const Beam& beam : scan.beams) {
    const double steps = even.step_rad > 0.0 ? (beam.angle_rad - even.first_rad) / even.step_rad : 0.0;
    const auto index = std::min(static_cast<std::size_t>(std::lround(steps)), count - 1);
    const float range = range_of(beam);
    if (std::isnan(range) || range >= even.ranges_m[index]) continue;
    even.ranges_m[index] = range;
    even.intensities[index] = beam.intensity;
  }
  return even;
}

std::vector<DiagnosticLine> diagnostics_of(const Ros2Report& report) {
  return {localization_line(report), base_line(report), motion_line(report)};
}

}  // namespace lodestar
