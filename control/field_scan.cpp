#include "control/field_scan.hpp"

#include <algorithm>

namespace lodestar {

std::vector<FieldHit> seen_from(const Pose2& odom_from_base, Stamp now, const FieldScan& scan,
                                double within_m) {
  const Pose2 base_from_odom = inverse(odom_from_base);
  const Eigen::Matrix2d turned = Eigen::Rotation2Dd(base_from_odom.yaw_rad).toRotationMatrix();
  const double within_squared_m2 = square(within_m);
  std::vector<FieldHit> hits;
  hits.reserve(scan.points.size());
  for (const FieldPoint& point : scan.points) {
    const Vec2 point_in_base = base_from_odom.position_m + turned * point.point_in_odom;
    if (point_in_base.squaredNorm() > within_squared_m2) continue;
    hits.push_back({point_in_base, std::max(seconds(now - point.stamp), 0.0), point.presence, point.stays});
  }
  return hits;
}

}  // namespace lodestar
