#include "drivers/simulation/image_former.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "drivers/simulation/dot_information.hpp"

namespace lodestar {
namespace {

/// A pixel integrates light over its area: a box blur.
constexpr double pixel_area_variance_px2 = 1.0 / 12.0;

/// Bound on the rays of a lens with a field of view near 180 degrees.
constexpr double widest_useful_ray = 20.0;

double widest_ray_of(const CameraModel& camera) {
  double widest = 0.0;
  const auto widen = [&](double u, double v) {
    const std::optional<Vec2> ray = camera.normalized({u, v});
    widest = std::max(widest, ray ? ray->norm() : widest_useful_ray);
  };
  constexpr int steps = 16;
  for (int i = 0; i <= steps; ++i) {
    const double u = static_cast<double>(camera.width_px - 1) * i / steps;
    const double v = static_cast<double>(camera.height_px - 1) * i / steps;
    widen(u, 0.0);
    widen(u, camera.height_px - 1.0);
    widen(0.0, v);
    widen(camera.width_px - 1.0, v);
  }
  return std::min(widest, widest_useful_ray);
}

Eigen::Isometry3d halfway(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.translation() = 0.5 * (from.translation() + to.translation());
  result.linear() = Eigen::Quaterniond(from.linear()).slerp(0.5, Eigen::Quaterniond(to.linear())).matrix();
  return result;
}

/// Sensor response up to full scale: linear in the dark, flat near saturation, which is why dots look alike
/// from near and far.
double shoulder(double light) {
  constexpr double steepness = 7.0;
  static const double at_full_scale = 1.0 - std::exp(-steepness);
  return (1.0 - std::exp(-steepness * light)) / at_full_scale;
}

std::variant<CeilingBackground, CeilingSurface> background_of(const CameraModel& camera,
                                                              const Vignetting& vignetting,
                                                              const SimulatedCameraOptions& options,
                                                              std::uint64_t seed) {
  if (options.ceiling == CeilingKind::tiles)
    return CeilingBackground(camera, vignetting, options.background_gray, options.texture_gray, seed);
  return CeilingSurface(camera, vignetting, options, seed);
}

}  // namespace

struct ImageFormer::Shutter {
  Shutter(const Eigen::Isometry3d& map_from_camera_at_opening,
          const Eigen::Isometry3d& map_from_camera_at_closing)
      : map_from_camera(halfway(map_from_camera_at_opening, map_from_camera_at_closing)),
        camera_from_map(map_from_camera.inverse()),
        camera_from_map_at_opening(map_from_camera_at_opening.inverse()),
        camera_from_map_at_closing(map_from_camera_at_closing.inverse()) {}

  /// Image motion of a point while the shutter is open.
  [[nodiscard]] Vec2 motion_px(const Vec3& point_in_map, const CameraModel& camera) const {
    const std::optional<Vec2> first = camera.project(camera_from_map_at_opening * point_in_map);
    const std::optional<Vec2> last = camera.project(camera_from_map_at_closing * point_in_map);
    return first && last ? Vec2(*last - *first) : Vec2(Vec2::Zero());
  }

  Eigen::Isometry3d map_from_camera;  ///< at mid-exposure
  Eigen::Isometry3d camera_from_map;
  Eigen::Isometry3d camera_from_map_at_opening;
  Eigen::Isometry3d camera_from_map_at_closing;
};

ImageFormer::ImageFormer(const MarkerRegistry& registry, const CameraModel& camera,
                         const SimulatedCameraOptions& options, std::uint64_t seed)
    : camera_(camera),
      options_(options),
      ceiling_(fit_ceiling(registry, options, seed)),
      vignetting_(camera, options.vignetting),
      blur_sigma_px_(std::sqrt(options.blur_sigma_px * options.blur_sigma_px + pixel_area_variance_px2)),
      widest_ray_(widest_ray_of(camera)),
      background_(background_of(camera, vignetting_, options, seed)),
      noise_(options.read_noise_gray, options.shot_noise_gray_at_255, seed),
      light_(camera.width_px, camera.height_px) {}

cv::Mat ImageFormer::expose(const Eigen::Isometry3d& map_from_camera_at_opening,
                            const Eigen::Isometry3d& map_from_camera_at_closing, std::uint64_t frame_number) {
  const Shutter shutter(map_from_camera_at_opening, map_from_camera_at_closing);
  std::visit([&](auto& background) { background.paint(ceiling_, shutter.map_from_camera, light_); },
             background_);
  paint_squares(squares_, shutter);
  for (const CeilingTube& tube : ceiling_.tubes) paint_tube(tube, shutter);
  for (const CeilingDisc& lamp : ceiling_.lamps) paint_disc(lamp, lamp.gray, shutter);
  for (const CeilingDisc& lamp : more_lamps_) paint_disc(lamp, lamp.gray, shutter);
  for (const CeilingDisc& glint : ceiling_.glints) paint_disc(glint, glint.gray, shutter);
  paint_markers(shutter);
  paint_squares(covers_, shutter);
  return noise_.expose(light_, frame_number);
}

void ImageFormer::paint_tube(const CeilingTube& tube, const Shutter& shutter) {
  // Straight segments approximate the curve to which the lens distorts a straight tube.
  constexpr std::size_t pieces = 12;
  const Vec3 step = (tube.to_m - tube.from_m) / static_cast<double>(pieces);
  std::array<std::optional<Vec2>, pieces + 1> joints;
  for (std::size_t i = 0; i <= pieces; ++i) {
    const Vec3 in_camera = shutter.camera_from_map * (tube.from_m + static_cast<double>(i) * step);
    if (may_show(in_camera, step.norm())) joints[i] = camera_.project(in_camera);
  }
  const auto cut_at = [&](std::size_t i) -> std::optional<Vec2> {
    if (i == 0 || i == pieces) return std::nullopt;
    const Vec2 before = joints[i - 1].value_or(*joints[i]);
    const Vec2 after = joints[i + 1].value_or(*joints[i]);
    return (after - before).normalized();
  };
  const Vec3 aside = tube.radius_m * Vec3(-step.y(), step.x(), 0.0).normalized();
  for (std::size_t i = 0; i < pieces; ++i) {
    if (!joints[i] || !joints[i + 1]) continue;
    const Vec3 middle = tube.from_m + (static_cast<double>(i) + 0.5) * step;
    const std::optional<Vec2> left = camera_.project(shutter.camera_from_map * (middle + aside));
    const std::optional<Vec2> right = camera_.project(shutter.camera_from_map * (middle - aside));
    if (!left || !right) continue;
    // A saturated tube shows motion at its edges only, where motion blur adds to the variance of the blur.
    const double smear_variance_px2 = shutter.motion_px(middle, camera_).squaredNorm() / 12.0;
    const double sigma_px = std::sqrt(blur_sigma_px_ * blur_sigma_px_ + smear_variance_px2);
    const double half_width_px = 0.5 * (*left - *right).norm();
    light_.paint(LightImage::Band{*joints[i], *joints[i + 1], half_width_px, cut_at(i), cut_at(i + 1)},
                 tube.gray, sigma_px, profile_);
  }
}

void ImageFormer::paint_disc(const CeilingDisc& disc, double gray, const Shutter& shutter) {
  if (!may_show(shutter.camera_from_map * disc.center_m, disc.radius_m)) return;
  const std::optional<ProjectedDisc> ellipse =
      project_disc(disc.center_m, disc.radius_m, shutter.camera_from_map, camera_);
  if (!ellipse) return;
  light_.paint(*ellipse, shutter.motion_px(disc.center_m, camera_), gray, blur_sigma_px_, profile_);
}

void ImageFormer::paint_markers(const Shutter& shutter) {
  for (const CeilingMarker& marker : ceiling_.markers) {
    if (!may_show(shutter.camera_from_map * marker.middle_m, marker_film_half_side_m)) continue;
    for (const CeilingDisc& dot : marker.dots) paint_disc(dot, dot_gray(dot, shutter), shutter);
  }
}

void ImageFormer::paint_squares(const std::vector<PrintedSquare>& squares, const Shutter& shutter) {
  for (const PrintedSquare& square : squares) {
    if (!may_show(shutter.camera_from_map * square.map_from_square.translation(), square.side_m)) continue;
    paint_square(square, shutter.camera_from_map, camera_, vignetting_, blur_sigma_px_, light_);
  }
}

std::vector<SeenDot> ImageFormer::dots_in_view(const Eigen::Isometry3d& map_from_camera) const {
  const Shutter shutter(map_from_camera, map_from_camera);
  std::vector<SeenDot> seen;
  for (std::size_t i = 0; i < ceiling_.markers.size(); ++i) {
    for (const CeilingDisc& dot : ceiling_.markers[i].dots) {
      const std::optional<ProjectedDisc> disc =
          project_disc(dot.center_m, dot.radius_m, shutter.camera_from_map, camera_);
      if (!disc || !camera_.contains(disc->center_px, disc->half_size_px.maxCoeff())) continue;
      const double background_gray = options_.background_gray * vignetting_.at(disc->center_px);
      const DiscImaging imaging{dot_gray(dot, shutter), background_gray, blur_sigma_px_,
                                options_.read_noise_gray, options_.shot_noise_gray_at_255};
      seen.push_back({i, dot.center_m, disc->center_px, information_on_center(*disc, imaging, profile_)});
    }
  }
  return seen;
}

bool ImageFormer::may_show(const Vec3& point_in_camera, double reach_m) const {
  constexpr double nearest_m = 0.05;
  const double depth_m = point_in_camera.z();
  return depth_m > nearest_m && point_in_camera.head<2>().norm() < widest_ray_ * depth_m + 2.0 * reach_m;
}

double ImageFormer::dot_gray(const CeilingDisc& dot, const Shutter& shutter) const {
  const Vec3 in_camera = shutter.camera_from_map * dot.center_m;
  const std::optional<Vec2> pixel = camera_.project(in_camera);
  if (!pixel) return 0.0;
  // The exposure suits the ceiling's height; a dot nearer to the camera receives more of the ring's light.
  const double usual_depth_m = ceiling_.height_m - shutter.map_from_camera.translation().z();
  const double nearness = usual_depth_m / in_camera.z();
  return dot.gray * shoulder(vignetting_.at(*pixel) * nearness * nearness);
}

}  // namespace lodestar
