#include "drivers/simulation/simulated_depth_camera.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/core.hpp>

#include "maps/ray_casting.hpp"

namespace lodestar {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

/// To an upright box, from outside (slab method; Kay and Kajiya 1986).
double to_box_m(const Vec3& from, const Vec3& way, const Overhang& box) {
  const Vec3 low(box.low_m.x(), box.low_m.y(), box.bottom_m);
  const Vec3 high(box.high_m.x(), box.high_m.y(), box.top_m);
  double enter = 0.0;
  double leave = never;
  for (int axis = 0; axis < 3; ++axis) {
    const double near = (low[axis] - from[axis]) / way[axis];
    const double far = (high[axis] - from[axis]) / way[axis];
    if (std::isnan(near) || std::isnan(far)) continue;  // along a face
    enter = std::max(enter, std::min(near, far));
    leave = std::min(leave, std::max(near, far));
  }
  return enter <= leave ? enter : never;
}

}  // namespace

SimulatedDepthCamera::SimulatedDepthCamera(const OccupancyMap& map, std::span<const Overhang> overhangs,
                                           const SimulatedDepthCameraOptions& options, std::uint64_t seed)
    : map_(map), overhangs_(overhangs.begin(), overhangs.end()), options_(options), random_(seed) {}

void SimulatedDepthCamera::observe(Stamp now, const Pose2& true_map_from_base,
                                   std::span<const DiscState> discs) {
  now_ = now;
  if (now < next_) return;
  next_ += from_seconds(1.0 / options_.rate_hz);
  on_their_way_.push_back({image_from(now, true_map_from_base, discs), now + options_.delay});
}

std::optional<DepthImage> SimulatedDepthCamera::poll() {
  if (on_their_way_.empty() || on_their_way_.front().arrival > now_) return std::nullopt;
  DepthImage image = std::move(on_their_way_.front().image);
  on_their_way_.pop_front();
  return image;
}

DepthImage SimulatedDepthCamera::image_from(Stamp now, const Pose2& map_from_base,
                                            std::span<const DiscState> discs) {
  const CameraModel& camera = options_.mount.camera;
  const Eigen::Isometry3d map_from_camera = lifted(map_from_base) * options_.mount.base_from_camera;
  const Vec3 from = map_from_camera.translation();
  DepthImage image{.stamp = now, .depth_mm = cv::Mat::zeros(camera.height_px, camera.width_px, CV_16UC1)};
  const int side = options_.pixels_a_side;
  for (int y = 0; y < camera.height_px; y += side) {
    for (int x = 0; x < camera.width_px; x += side) {
      const Vec3 ray((x + 0.5 * (side - 1) - camera.cx_px) / camera.fx_px,
                     (y + 0.5 * (side - 1) - camera.cy_px) / camera.fy_px, 1.0);
      const double depth_m = range_m(from, map_from_camera.linear() * ray, discs);  // along the optical axis
      const double noise_m = random_.normal() * options_.sigma_per_m2 * square(depth_m);
      const bool is_known = random_.uniform() >= options_.unknown_share && depth_m >= options_.least_m &&
                            depth_m < std::numeric_limits<std::uint16_t>::max() / mm_per_m;
      if (!is_known) continue;
      const cv::Rect block(x, y, std::min(side, camera.width_px - x), std::min(side, camera.height_px - y));
      image.depth_mm(block).setTo(std::max(std::round(mm_per_m * (depth_m + noise_m)), 1.0));
    }
  }
  return image;
}

/// To the nearest of all, in lengths of `way`.
double SimulatedDepthCamera::range_m(const Vec3& from, const Vec3& way,
                                     std::span<const DiscState> discs) const {
  double nearest = way.z() < 0.0 ? -from.z() / way.z() : never;  // the floor
  for (const Overhang& overhang : overhangs_) nearest = std::min(nearest, to_box_m(from, way, overhang));
  const double across = way.head<2>().norm();
  if (across < 1e-9) return nearest;
  const auto stands_m = [&](const std::optional<RayHit>& hit, double height_m) {
    if (!hit) return;
    const double at = hit->range_m / across;
    if (from.z() + at * way.z() <= height_m) nearest = std::min(nearest, at);
  };
  const Vec2 direction = way.head<2>() / across;
  for (const DiscState& disc : discs)
    stands_m(cast_ray_at_disc(from.head<2>(), direction, disc.position_m, disc.radius_m), options_.person_m);
  constexpr double farthest_m = 12.0;  // beyond it there is no disparity to speak of
  const double far_m = std::min(nearest * across, farthest_m);
  stands_m(cast_ray(map_, from.head<2>(), std::atan2(direction.y(), direction.x()), far_m), options_.wall_m);
  return nearest;
}

}  // namespace lodestar
