#include "localization/scan/deskewed.hpp"

#include <algorithm>
#include <cmath>

namespace lodestar {
namespace {

/// Where a ray ends that hits nothing and whose scanner does not say how far it sees.
constexpr double far_m = 100.0;

double length_m(const Beam& beam, const Scan& scan) {
  switch (beam.echo) {
    case Echo::hit:
      return beam.range_m;
    case Echo::nothing:
      return std::min(scan.max_range_m, far_m);
    case Echo::too_near:
      return scan.min_range_m;
    case Echo::invalid:
      break;
  }
  return 1.0;
}

}  // namespace

Vec2 end_in_base(const Beam& beam, const Scan& scan, const ScannerMount& mount) {
  const Vec2 way(std::cos(beam.angle_rad), std::sin(beam.angle_rad));
  return mount.base_from_scanner * Vec2(length_m(beam, scan) * way);
}

std::optional<std::vector<Pose2>> poses_during(const Scan& scan, const WheelTrack& track) {
  if (scan.beams.empty()) return std::nullopt;
  std::vector<Pose2> odom_from_base;
  odom_from_base.reserve(scan.beams.size());
  for (const Beam& beam : scan.beams) {
    const std::optional<Pose2> pose = track.pose_at(beam.stamp);
    if (!pose) return std::nullopt;
    odom_from_base.push_back(*pose);
  }
  return odom_from_base;
}

DeskewedScan deskewed(const Scan& scan, const ScannerMount& mount, std::span<const Pose2> odom_from_base,
                      const OwnOutline& own, const OwnParts& parts) {
  DeskewedScan result{.newest = scan.beams.front().stamp, .rays = {}};
  result.rays.reserve(scan.beams.size());
  for (std::size_t i = 0; i < scan.beams.size(); ++i) {
    const Beam& beam = scan.beams[i];
    const Vec2 end = end_in_base(beam, scan, mount);
    result.newest = std::max(result.newest, beam.stamp);
    const Ray ray{beam.stamp, odom_from_base[i] * mount.base_from_scanner.position_m, odom_from_base[i] * end,
                  beam.echo};
    if (ends_at_something(ray) && own.holds(end) && parts.has(beam.angle_rad)) continue;
    result.rays.push_back(ray);
  }
  return result;
}

}  // namespace lodestar
