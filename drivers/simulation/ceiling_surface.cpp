#include "drivers/simulation/ceiling_surface.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/simulation/ceiling_light.hpp"

namespace lodestar {
namespace {

constexpr double pixel_area_variance_px2 = 1.0 / 12.0;
constexpr double steps_per_octave = 4.0;

constexpr Glow beside_reflectors{.gray = 28.0, .reach_m = 0.15};  // of each of a reflector's four bands

/// Glossy paint mirrors a ring around the lens at the foot of the perpendicular; roughness widens the spot.
constexpr double mirrored_gray = 80.0;
constexpr double mirrored_spread =
    0.07;  // sigma of the spot, as a share of the ceiling's distance: 4 degrees

double mirrored_light(const Vec2& from_foot_m, double depth_m) {
  return mirrored_gray * std::exp(-0.5 * from_foot_m.squaredNorm() / std::pow(mirrored_spread * depth_m, 2));
}

}  // namespace

CeilingSurface::CeilingSurface(const CameraModel& camera, const Vignetting& vignetting,
                               const SimulatedCameraOptions& options, std::uint64_t seed)
    : options_(options), focal_px_(camera.fx_px), reflectance_(reflectance_of(options.ceiling, seed)) {
  for (int v = 0; v < camera.height_px; ++v) {
    for (int u = 0; u < camera.width_px; ++u) {
      rays_.push_back(ray_through(Vec2(u, v), camera));
      falloff_.push_back(vignetting.at(Vec2(u, v)));
    }
  }
}

/// The reflectance as blurred by lens and pixel from this distance, rounded to a quarter octave.
const SurfaceReflectance& CeilingSurface::as_imaged(double depth_m) {
  const double sigma_m =
      std::sqrt(options_.blur_sigma_px * options_.blur_sigma_px + pixel_area_variance_px2) * depth_m /
      focal_px_;
  const int level = static_cast<int>(std::lround(steps_per_octave * std::log2(sigma_m)));
  if (blur_level_ != level) {
    imaged_ = reflectance_.blurred(std::exp2(level / steps_per_octave));
    blur_level_ = level;
  }
  return imaged_;
}

void CeilingSurface::paint(const Ceiling& ceiling, const Eigen::Isometry3d& map_from_camera,
                           LightImage& image) {
  const Vec3 from = map_from_camera.translation();
  const double depth_m = std::max(ceiling.height_m - from.z(), 0.01);
  const SurfaceReflectance& reflectance = as_imaged(depth_m);
  const Glow glow = options_.ceiling == CeilingKind::reflectors ? beside_reflectors : Glow{};
  const double radius_m =
      (meet_ceiling(from, map_from_camera.linear() * rays_.front(), ceiling.height_m) - from.head<2>())
          .norm();
  const Ceiling lights = lights_near(ceiling, from.head<2>(), radius_m);
  const Eigen::Matrix3d rotation = map_from_camera.linear();
  std::size_t i = 0;
  for (int v = 0; v < image.height_px(); ++v) {
    std::int16_t* const row = image.row(v);
    for (int u = 0; u < image.width_px(); ++u, ++i) {
      const Vec2 point = meet_ceiling(from, rotation * rays_[i], ceiling.height_m);
      const Vec2 from_corner = point - ceiling.tile_corner_m;
      double gray =
          options_.background_gray * static_cast<double>(reflectance.at(from_corner.x(), from_corner.y()));
      gray += glow_of_lights(lights, point, glow);
      if (options_.ceiling == CeilingKind::glossy) gray += mirrored_light(point - from.head<2>(), depth_m);
      row[u] = static_cast<std::int16_t>(LightImage::units_per_gray *
                                         std::clamp(gray * falloff_[i], 0.0, LightImage::brightest_gray));
    }
  }
}

}  // namespace lodestar
