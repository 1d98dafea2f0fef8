#include "localization/p3p.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

namespace lodestar {
namespace {

using Mat3 = Eigen::Matrix3d;

/// Cosines between the rays, and squared sides of the triangle, for the pairs (0,1), (0,2), (1,2).
struct Triangle {
  Vec3 cosines;
  Vec3 squared_sides;
};

constexpr std::array<std::pair<int, int>, 3> pairs{{{0, 1}, {0, 2}, {1, 2}}};

/// The left side of Eq. (10) for one pair as a quadratic form of the three depths.
Mat3 side_form(const Triangle& triangle, std::size_t pair) {
  const auto [i, j] = pairs[pair];
  Mat3 form = Mat3::Zero();
  form(i, i) = form(j, j) = 1.0;
  form(i, j) = form(j, i) = -triangle.cosines[static_cast<Eigen::Index>(pair)];
  return form;
}

Mat3 adjugate(const Mat3& m) {
  Mat3 result;
  result.row(0) = m.col(1).cross(m.col(2));
  result.row(1) = m.col(2).cross(m.col(0));
  result.row(2) = m.col(0).cross(m.col(1));
  return result;
}

struct RealRoots {
  std::array<double, 3> values{};
  std::size_t count = 0;
};

/// Real roots of x^3 + b x^2 + c x + d (Viete's trigonometric form, or Cardano's), polished by Newton's
/// method.
RealRoots cubic_roots(double b, double c, double d) {
  const double shift = b / 3.0;
  const double p = c - b * shift;
  const double q = d + shift * (2.0 * shift * shift - c);
  const double discriminant = 0.25 * q * q + p * p * p / 27.0;
  RealRoots roots;
  if (discriminant > 0.0) {
    const double s = std::sqrt(discriminant);
    const double u = std::cbrt(-0.5 * q + (q > 0.0 ? -s : s));  // the sum that does not cancel
    roots = {{(u == 0.0 ? 0.0 : u - p / (3.0 * u)) - shift}, 1};
  } else {
    const double radius = 2.0 * std::sqrt(std::max(-p / 3.0, 0.0));
    const double cosine = radius > 0.0 ? std::clamp(3.0 * q / (p * radius), -1.0, 1.0) : 0.0;
    const double angle = std::acos(cosine) / 3.0;
    for (int k = 0; k < 3; ++k) {
      roots.values[static_cast<std::size_t>(k)] =
          radius * std::cos(angle - 2.0 * std::numbers::pi * k / 3.0) - shift;
    }
    roots.count = 3;
  }
  for (double& x : roots.values) {
    for (int i = 0; i < 2; ++i) {
      const double slope = c + x * (2.0 * b + 3.0 * x);
      if (slope != 0.0) x -= (d + x * (c + x * (b + x))) / slope;
    }
  }
  return roots;
}

/// The two planes through the origin into which a degenerate form falls apart; nothing when they are not
/// real.
struct PlanePair {
  Vec3 first;
  Vec3 second;
  double quality = 0.0;  ///< how far both are from falling together
};

std::optional<PlanePair> planes_of(const Mat3& form) {
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(form);
  const Vec3& values = solver.eigenvalues();  // ascending; the one nearest to zero is the middle one
  if (!(values[0] < 0.0 && values[2] > 0.0)) return std::nullopt;
  const Vec3 up = std::sqrt(values[2]) * solver.eigenvectors().col(2);
  const Vec3 down = std::sqrt(-values[0]) * solver.eigenvectors().col(0);
  const double quality = std::min(values[2], -values[0]) / std::max(values[2], -values[0]);
  return PlanePair{up + down, up - down, quality};
}

/// A degenerate form of the pencil that the two homogeneous equations span, taken apart.
std::optional<PlanePair> best_planes(const Mat3& first, const Mat3& second) {
  const double leading = second.determinant();
  if (leading == 0.0) return planes_of(second);
  const RealRoots roots =
      cubic_roots((first * adjugate(second)).trace() / leading, (adjugate(first) * second).trace() / leading,
                  first.determinant() / leading);
  std::optional<PlanePair> best;
  for (std::size_t i = 0; i < roots.count; ++i) {
    const std::optional<PlanePair> planes = planes_of(first + roots.values[i] * second);
    if (planes && (!best || planes->quality > best->quality)) best = planes;
  }
  return best;
}

/// Where the form vanishes on the plane: up to two directions of the three depths.
std::array<std::optional<Vec3>, 2> directions_on(const Vec3& plane_normal, const Mat3& form) {
  const Vec3 normal = plane_normal.normalized();
  const Vec3 p = normal.unitOrthogonal();
  const Vec3 q = normal.cross(p);
  const double a = p.dot(form * p);
  const double b = p.dot(form * q);
  const double c = q.dot(form * q);
  const double scale = a * a + b * b + c * c;
  double discriminant = b * b - a * c;
  if (discriminant < -1e-6 * scale) return {};
  discriminant = std::max(discriminant, 0.0);  // touching: noise parts the double root of a frontal view
  const double s = b + (b >= 0.0 ? std::sqrt(discriminant) : -std::sqrt(discriminant));
  // a u^2 + 2 b u v + c v^2 = 0 has the roots (u : v) = (-s : a) and (-c : s), neither of which cancels.
  return {Vec3(-s * p + a * q), Vec3(-c * p + s * q)};
}

Vec3 residual_of(const Triangle& triangle, const Vec3& depths) {
  Vec3 residual;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const auto [i, j] = pairs[static_cast<std::size_t>(k)];
    residual[k] = depths[i] * depths[i] + depths[j] * depths[j] -
                  2.0 * triangle.cosines[k] * depths[i] * depths[j] - triangle.squared_sides[k];
  }
  return residual;
}

/// Newton's method on Eq. (10), damped where two solutions nearly fall together.
std::optional<Vec3> polished(const Triangle& triangle, Vec3 depths) {
  const double size = triangle.squared_sides.sum();
  for (int iteration = 0; iteration < 8; ++iteration) {
    const Vec3 residual = residual_of(triangle, depths);
    if (residual.cwiseAbs().maxCoeff() < 1e-14 * size) break;
    Mat3 jacobian = Mat3::Zero();
    for (Eigen::Index k = 0; k < 3; ++k) {
      const auto [i, j] = pairs[static_cast<std::size_t>(k)];
      jacobian(k, i) = 2.0 * (depths[i] - triangle.cosines[k] * depths[j]);
      jacobian(k, j) = 2.0 * (depths[j] - triangle.cosines[k] * depths[i]);
    }
    Mat3 normal = jacobian.transpose() * jacobian;
    normal.diagonal().array() += 1e-14 * normal.trace();
    depths -= normal.ldlt().solve(jacobian.transpose() * residual);
  }
  constexpr double tolerance = 1e-6;  // of the squared sides: a double root that noise has parted stays near
  const bool good = depths.allFinite() && (depths.array() > 0.0).all() &&
                    residual_of(triangle, depths).cwiseAbs().maxCoeff() < tolerance * size;
  return good ? std::optional(depths) : std::nullopt;
}

/// The direction of the depths, brought to scale by the sum of Eq. (10).
std::optional<Vec3> depths_along(const Triangle& triangle, Vec3 direction) {
  if (direction.sum() < 0.0) direction = -direction;
  if (!((direction.array() > 0.0).all())) return std::nullopt;
  Triangle unit = triangle;
  unit.squared_sides.setZero();
  const double size = residual_of(unit, direction).sum();
  if (!(size > 0.0)) return std::nullopt;
  return polished(triangle, direction * std::sqrt(triangle.squared_sides.sum() / size));
}

/// Right-handed axes of a triangle: along its first side, normal to it.
Mat3 axes_of(const std::array<Vec3, 3>& points) {
  const Vec3 x = (points[1] - points[0]).normalized();
  const Vec3 z = x.cross(points[2] - points[0]).normalized();
  Mat3 axes;
  axes << x, z.cross(x), z;
  return axes;
}

/// Eq. (14) and (15).
Eigen::Isometry3d motion_for(const std::array<Vec3, 3>& rays, const Vec3& depths,
                             const std::array<Vec3, 3>& points) {
  const std::array<Vec3, 3> in_camera{depths[0] * rays[0], depths[1] * rays[1], depths[2] * rays[2]};
  Eigen::Isometry3d camera_from_points = Eigen::Isometry3d::Identity();
  camera_from_points.linear() = axes_of(in_camera) * axes_of(points).transpose();
  const Vec3 center_in_camera = (in_camera[0] + in_camera[1] + in_camera[2]) / 3.0;
  const Vec3 center = (points[0] + points[1] + points[2]) / 3.0;
  camera_from_points.translation() = center_in_camera - camera_from_points.linear() * center;
  return camera_from_points;
}

Triangle triangle_of(const std::array<Vec3, 3>& rays, const std::array<Vec3, 3>& points) {
  Triangle triangle;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto i = static_cast<std::size_t>(pairs[k].first);
    const auto j = static_cast<std::size_t>(pairs[k].second);
    triangle.cosines[static_cast<Eigen::Index>(k)] = rays[i].dot(rays[j]);
    triangle.squared_sides[static_cast<Eigen::Index>(k)] = (points[i] - points[j]).squaredNorm();
  }
  return triangle;
}

bool on_a_line(const std::array<Vec3, 3>& points) {
  const Vec3 a = points[1] - points[0];
  const Vec3 b = points[2] - points[0];
  return !(a.cross(b).squaredNorm() > 1e-12 * a.squaredNorm() * b.squaredNorm());
}

}  // namespace

P3pSolutions solve_p3p(const std::array<Vec3, 3>& rays, const std::array<Vec3, 3>& points) {
  P3pSolutions solutions;
  if (on_a_line(points)) return solutions;
  const Triangle triangle = triangle_of(rays, points);
  const Vec3& a = triangle.squared_sides;
  const Mat3 first = side_form(triangle, 0) * a[2] - side_form(triangle, 2) * a[0];
  const Mat3 second = side_form(triangle, 1) * a[2] - side_form(triangle, 2) * a[1];
  if (!first.allFinite() || !second.allFinite()) return solutions;
  const std::optional<PlanePair> planes = best_planes(first, second);
  if (!planes) return solutions;
  for (const Vec3& plane : {planes->first, planes->second}) {
    for (const std::optional<Vec3>& direction : directions_on(plane, second)) {
      if (!direction) continue;
      const std::optional<Vec3> depths = depths_along(triangle, *direction);
      if (!depths) continue;
      solutions.camera_from_points[solutions.count++] = motion_for(rays, *depths, points);
    }
  }
  return solutions;
}

}  // namespace lodestar
