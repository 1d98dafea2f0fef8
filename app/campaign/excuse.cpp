#include "app/campaign/excuse.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "app/campaign/random_faults.hpp"
#include "drivers/simulation/disc_contact.hpp"
#include "maps/marker.hpp"

namespace lodestar {
namespace {

/// An obstacle holds the robot up before the recorded poses overlap it.
constexpr double touching_m = 0.01;

std::optional<Stamp> first_contact(const RunRecord& record, const Site& site) {
  const auto touches = [&](const TruePose& pose) {
    return disc_overlaps_obstacle(site.map.map, pose.map_from_base.position_m,
                                  site.robot.radius_m + touching_m);
  };
  const auto first = std::ranges::find_if(record.truth, touches);
  return first == record.truth.end() ? std::nullopt : std::optional(first->stamp);
}

bool is_wholly_in_view(const RegisteredMarker& marker, const Pose2& map_from_base, const Site& site,
                       const CameraModel& camera) {
  const Eigen::Isometry3d camera_from_marker =
      (lifted(map_from_base) * site.robot.base_from_camera).inverse() *
      map_from_marker(site.registry, marker);
  return std::ranges::all_of(dots_of(marker.id), [&](GridCell cell) {
    Vec3 dot = Vec3::Zero();
    dot.head<2>() = cell_in_marker(cell);
    const std::optional<Vec2> pixel = camera.project(camera_from_marker * dot);
    return pixel && camera.contains(*pixel);
  });
}

bool sees_a_marker(const RunRecord& record, const Site& site, Stamp from, Stamp to) {
  const CameraModel& camera = site.cameras.at(record.camera);
  return std::ranges::any_of(record.truth, [&](const TruePose& pose) {
    return pose.stamp > from && pose.stamp <= to &&
           std::ranges::any_of(site.registry.markers, [&](const RegisteredMarker& marker) {
             return is_wholly_in_view(marker, pose.map_from_base, site, camera);
           });
  });
}

bool is_wrong(const FixRecord& fix, const RunRecord& record) {
  constexpr double far_m = 0.05;
  const double far_rad = radians(3.0);
  const auto truth = std::ranges::lower_bound(record.truth, fix.stamp, {}, &TruePose::stamp);
  if (truth == record.truth.end()) return false;
  const Pose2 error = inverse(truth->map_from_base) * fix.map_from_base;
  return error.position_m.norm() > far_m || std::abs(error.yaw_rad) > far_rad;
}

/// By a marker that had been tampered with before the robot had any pose, and by no other.
bool is_misled_from_the_start(const RunRecord& record, Stamp tampered, Stamp until) {
  std::set<int> ids;
  for (const FixRecord& fix : record.fixes) {
    if (fix.stamp > until) break;
    if (fix.stamp < tampered || (fix.accepted && !is_wrong(fix, record))) return false;
    ids.insert(fix.ids.begin(), fix.ids.end());
  }
  return ids.size() == 1;
}

}  // namespace

std::optional<std::string> excuse_for_contact(const RunRecord& record, const Site& site) {
  const std::optional<Stamp> contact = first_contact(record, site);
  if (!contact) return std::nullopt;
  for (const FaultEvent& fault : record.faults) {
    if (fault.begin > *contact) continue;
    if (fault.kind == FaultKind::kidnapping && !sees_a_marker(record, site, fault.begin, *contact))
      return "put down, still rolling, where no marker was in view";
    if (misleads(fault.kind) && is_misled_from_the_start(record, fault.begin, *contact))
      return "has seen one marker only, and that had been tampered with before";
  }
  return std::nullopt;
}

}  // namespace lodestar
