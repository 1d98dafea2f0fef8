#include "maps/camera_model.hpp"

#include <cmath>
#include <numbers>

namespace lodestar {
namespace {

/// Brown-Conrady with OpenCV's rational radial factor; k4..k6 are zero for plumb_bob.
Vec2 brown_conrady(const Vec2& p, const std::array<double, 8>& k) {
  const double x = p.x();
  const double y = p.y();
  const double r2 = p.squaredNorm();
  const double radial =
      (1.0 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]))) / (1.0 + r2 * (k[5] + r2 * (k[6] + r2 * k[7])));
  return {x * radial + 2.0 * k[2] * x * y + k[3] * (r2 + 2.0 * x * x),
          y * radial + k[2] * (r2 + 2.0 * y * y) + 2.0 * k[3] * x * y};
}

Eigen::Matrix2d brown_conrady_jacobian(const Vec2& p, const std::array<double, 8>& k) {
  const double x = p.x();
  const double y = p.y();
  const double r2 = p.squaredNorm();
  const double above = 1.0 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
  const double below = 1.0 + r2 * (k[5] + r2 * (k[6] + r2 * k[7]));
  const double above_by_r2 = k[0] + r2 * (2.0 * k[1] + 3.0 * r2 * k[4]);
  const double below_by_r2 = k[5] + r2 * (2.0 * k[6] + 3.0 * r2 * k[7]);
  const double radial = above / below;
  const double radial_by_r2 = (above_by_r2 - radial * below_by_r2) / below;
  Eigen::Matrix2d j = radial * Eigen::Matrix2d::Identity() + 2.0 * radial_by_r2 * p * p.transpose();
  j(0, 0) += 2.0 * k[2] * y + 6.0 * k[3] * x;
  j(0, 1) += 2.0 * k[2] * x + 2.0 * k[3] * y;
  j(1, 0) += 2.0 * k[2] * x + 2.0 * k[3] * y;
  j(1, 1) += 6.0 * k[2] * y + 2.0 * k[3] * x;
  return j;
}

/// Kannala-Brandt (OpenCV fisheye): the image radius is an odd polynomial of the angle to the axis.
double fisheye_radius(double theta, const std::array<double, 8>& k) {
  const double t2 = theta * theta;
  return theta * (1.0 + t2 * (k[0] + t2 * (k[1] + t2 * (k[2] + t2 * k[3]))));
}
double fisheye_radius_by_theta(double theta, const std::array<double, 8>& k) {
  const double t2 = theta * theta;
  return 1.0 + t2 * (3.0 * k[0] + t2 * (5.0 * k[1] + t2 * (7.0 * k[2] + t2 * 9.0 * k[3])));
}

constexpr double tiny = 1e-9;

Vec2 fisheye(const Vec2& p, const std::array<double, 8>& k) {
  const double r = p.norm();
  return r < tiny ? p : Vec2(p * (fisheye_radius(std::atan(r), k) / r));
}

Eigen::Matrix2d fisheye_jacobian(const Vec2& p, const std::array<double, 8>& k) {
  const double r = p.norm();
  if (r < tiny) return Eigen::Matrix2d::Identity();
  const double theta = std::atan(r);
  const double scale = fisheye_radius(theta, k) / r;
  const double radius_by_r = fisheye_radius_by_theta(theta, k) / (1.0 + r * r);
  const Vec2 outward = p / r;
  return scale * Eigen::Matrix2d::Identity() + (radius_by_r - scale) * outward * outward.transpose();
}

/// Does the image around the rays at this angle to the axis lie the right way round, on all sides? Tangential
/// terms move the fold differently on each side.
bool keeps_orientation(const CameraModel& camera, double angle_rad) {
  constexpr int sides = 32;
  const double length = std::tan(angle_rad);
  for (int i = 0; i < sides; ++i) {
    const double side_rad = 2.0 * std::numbers::pi * i / sides;
    const Vec2 ray(length * std::cos(side_rad), length * std::sin(side_rad));
    if (!(camera.distorted_jacobian(ray).determinant() > 0.0)) return false;
  }
  return true;
}

}  // namespace

/// Steps outwards from the axis, where every lens keeps its orientation, to the first angle that does not,
/// and halves that last step.
void CameraModel::limit_rays() {
  widest_ray_squared = std::numeric_limits<double>::infinity();
  if (distortion == Distortion::none) return;
  constexpr int steps = 360;  // a quarter of a degree each
  constexpr int halvings = 30;
  constexpr double step_rad = 0.5 * std::numbers::pi / steps;
  int good = 0;
  while (good + 1 < steps && keeps_orientation(*this, (good + 1) * step_rad)) ++good;
  if (good + 1 == steps) return;
  double inside_rad = good * step_rad;
  double outside_rad = inside_rad + step_rad;
  for (int i = 0; i < halvings; ++i) {
    const double middle_rad = 0.5 * (inside_rad + outside_rad);
    (keeps_orientation(*this, middle_rad) ? inside_rad : outside_rad) = middle_rad;
  }
  const double widest_ray = std::tan(inside_rad);
  widest_ray_squared = widest_ray * widest_ray;
}

std::optional<Vec2> CameraModel::project(const Vec3& point_in_camera) const {
  if (!(point_in_camera.z() > 0.0)) return std::nullopt;
  const Vec2 ray = point_in_camera.head<2>() / point_in_camera.z();
  if (ray.squaredNorm() > widest_ray_squared) return std::nullopt;
  return distorted(ray);
}

Vec2 CameraModel::distorted(const Vec2& normalized) const {
  Vec2 p = normalized;
  if (distortion == Distortion::equidistant) {
    p = fisheye(p, coefficients);
  } else if (distortion != Distortion::none) {
    p = brown_conrady(p, coefficients);
  }
  return {fx_px * p.x() + cx_px, fy_px * p.y() + cy_px};
}

Eigen::Matrix2d CameraModel::distorted_jacobian(const Vec2& normalized) const {
  Eigen::Matrix2d j = Eigen::Matrix2d::Identity();
  if (distortion == Distortion::equidistant) {
    j = fisheye_jacobian(normalized, coefficients);
  } else if (distortion != Distortion::none) {
    j = brown_conrady_jacobian(normalized, coefficients);
  }
  return Eigen::DiagonalMatrix<double, 2>(fx_px, fy_px) * j;
}

std::optional<Vec2> CameraModel::normalized(const Vec2& pixel) const {
  const Vec2 wanted((pixel.x() - cx_px) / fx_px, (pixel.y() - cy_px) / fy_px);
  if (distortion == Distortion::none) return wanted;
  const auto within = [&](const Vec2& ray) {
    return ray.squaredNorm() <= widest_ray_squared ? std::optional<Vec2>(ray) : std::nullopt;
  };
  Vec2 guess = wanted;
  if (distortion == Distortion::equidistant) {
    // The image radius is close to the angle itself: a good initial guess for Newton's method.
    const double theta = wanted.norm();
    if (theta >= 0.5 * std::numbers::pi) return std::nullopt;
    if (theta > tiny) guess = wanted * (std::tan(theta) / theta);
  }
  constexpr int enough = 30;
  for (int i = 0; i < enough; ++i) {
    const Vec2 error = distorted(guess) - pixel;
    if (error.squaredNorm() < 1e-22 * (1.0 + pixel.squaredNorm())) return within(guess);
    const Eigen::Matrix2d j = distorted_jacobian(guess);
    if (!(j.determinant() > 0.0)) return std::nullopt;  // past the fold: no ray, or two, map here
    guess -= j.inverse() * error;
  }
  const bool converged = (distorted(guess) - pixel).squaredNorm() < 1e-12;
  return converged ? within(guess) : std::nullopt;
}

bool CameraModel::contains(const Vec2& pixel, double margin_px) const {
  return pixel.x() >= margin_px && pixel.y() >= margin_px && pixel.x() <= width_px - 1 - margin_px &&
         pixel.y() <= height_px - 1 - margin_px;
}

}  // namespace lodestar
