#include "app/recording/ceiling_follower.hpp"

#include "localization/survey/wheel_segment.hpp"
#include "maps/median.hpp"

namespace lodestar {
namespace {

/// Height of a marker above a level camera, by the length of its edges OX and OY.
std::optional<double> above_camera_m(const DetectedMarker& marker, const CameraModel& camera) {
  constexpr double edge_m = (marker_grid_size - 1) * marker_pitch_m;
  const std::optional<Vec2> o = camera.normalized(marker.o_px);
  const std::optional<Vec2> x = camera.normalized(marker.x_px);
  const std::optional<Vec2> y = camera.normalized(marker.y_px);
  if (!o || !x || !y) return std::nullopt;
  const double edges = (*x - *o).norm() + (*y - *o).norm();
  return edges > 0.0 ? std::optional(2.0 * edge_m / edges) : std::nullopt;
}

}  // namespace

CeilingFollower::CeilingFollower(const Robot& robot, const CameraModel& camera)
    : robot_(robot), camera_(camera) {}

void CeilingFollower::add(const WheelTravel& reading) {
  constexpr Duration kept = std::chrono::seconds(30);
  travel_.push_back(reading);
  while (reading.stamp - travel_.front().stamp > kept) travel_.pop_front();
}

std::optional<VisualOdometryIncrement> CeilingFollower::see(const Frame& frame,
                                                            std::span<const DetectedMarker> markers) {
  if (!ceiling_) measure_height(markers);
  if (!ceiling_) return std::nullopt;
  ceiling_->set_frame(frame);
  const std::optional<Stamp> keyframe = ceiling_->keyframe_stamp();
  const std::optional<Pose2> expected = keyframe ? rolled(*keyframe, frame.stamp) : std::nullopt;
  std::optional<VisualOdometryIncrement> motion;
  if (expected) motion = ceiling_->motion(*expected);
  if (!expected || ceiling_->leaves_view(*expected)) ceiling_->set_keyframe();
  return motion;
}

void CeilingFollower::measure_height(std::span<const DetectedMarker> markers) {
  constexpr std::size_t enough = 9;
  for (const DetectedMarker& marker : markers)
    if (const auto height_m = above_camera_m(marker, camera_)) heights_m_.push_back(*height_m);
  if (heights_m_.size() < enough) return;
  const double camera_m = robot_.base_from_camera.translation().z();
  ceiling_.emplace(camera_, robot_.base_from_camera, camera_m + median(heights_m_),
                   robot_.mount_tilt_sigma_rad);
}

std::optional<Pose2> CeilingFollower::rolled(Stamp from, Stamp to) const {
  const std::vector<WheelTravel> readings(travel_.begin(), travel_.end());
  const auto segment = WheelSegment::between(readings, from, to);
  if (!segment) return std::nullopt;
  const WheelMotion motion = segment->motion({.track_m = robot_.track_width_m});
  return Pose2{motion.way_m, motion.turn_rad};
}

}  // namespace lodestar
