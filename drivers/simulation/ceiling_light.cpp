#include "drivers/simulation/ceiling_light.hpp"

#include <algorithm>
#include <iterator>

#include "maps/segment.hpp"

namespace lodestar {
namespace {

double squared_distance_m2(const CeilingTube& tube, const Vec2& point) {
  return (nearest_on_segment(tube.from_m.head<2>(), tube.to_m.head<2>(), point) - point).squaredNorm();
}

double squared_distance_m2(const CeilingDisc& lamp, const Vec2& point) {
  return std::max((lamp.center_m.head<2>() - point).squaredNorm() - lamp.radius_m * lamp.radius_m, 0.0);
}

double glow_at(double squared_distance_m2, const Glow& glow) {
  const double fall = 1.0 / (1.0 + squared_distance_m2 / (glow.reach_m * glow.reach_m));
  return glow.gray * fall * fall;
}

}  // namespace

Vec3 ray_through(const Vec2& pixel, const CameraModel& camera) {
  const Vec2 pinhole((pixel.x() - camera.cx_px) / camera.fx_px, (pixel.y() - camera.cy_px) / camera.fy_px);
  return camera.normalized(pixel).value_or(pinhole).homogeneous();
}

Vec2 meet_ceiling(const Vec3& from, const Vec3& ray, double height_m) {
  constexpr double least_rise = 0.05;
  const double distance = std::max(height_m - from.z(), 0.0) / std::max(ray.z(), least_rise);
  return from.head<2>() + distance * ray.head<2>();
}

double glow_of_lights(const Ceiling& ceiling, const Vec2& point, const Glow& glow) {
  double gray = 0.0;
  for (const CeilingTube& tube : ceiling.tubes) gray += glow_at(squared_distance_m2(tube, point), glow);
  for (const CeilingDisc& lamp : ceiling.lamps) gray += glow_at(squared_distance_m2(lamp, point), glow);
  return gray;
}

Ceiling lights_near(const Ceiling& ceiling, const Vec2& middle, double radius_m) {
  constexpr double farthest_glow_m = 0.8;
  const double near = (radius_m + farthest_glow_m) * (radius_m + farthest_glow_m);
  const auto is_near = [&](const auto& light) { return squared_distance_m2(light, middle) < near; };
  Ceiling result;
  std::ranges::copy_if(ceiling.tubes, std::back_inserter(result.tubes), is_near);
  std::ranges::copy_if(ceiling.lamps, std::back_inserter(result.lamps), is_near);
  return result;
}

}  // namespace lodestar
