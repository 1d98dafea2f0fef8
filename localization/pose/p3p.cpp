#include "localization/pose/p3p.hpp"

#include <Eigen/LU>
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

/// Real roots of x^3 + b x^2 + c x + d (Viete's trigonometric form, or Cardano's), refined by Newton's
/// method.
RealRoots cubic_roots(double b, double c, double d) {
  const double shift = b / 3.0;
  const double p = c - b * shift;
  const double q = d + shift * (2.0 * shift * shift - c);
  const double discriminant = 0.25 * q * q + p * p * p / 27.0;
  RealRoots roots;
  if (discriminant > 0.0) {
    const double s = std::sqrt(discriminant);
    const double u = std::cbrt(-0.5 * q + (q > 0.0 ? -s : s));  // the sign without cancellation
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

/// A form of rank two, which splits into two planes through the origin.
struct DegenerateForm {
  Mat3 form;
  Mat3 adjugate;  ///< -v v^T with v = p x q / 2 of the planes p and q
  /// Separation of the planes; not positive when they are not real.
  [[nodiscard]] double quality() const { return -adjugate.trace() / form.squaredNorm(); }
};

/// Of the pencil of the two homogeneous equations, the degenerate form with the best separated planes;
/// nothing when none has real planes.
std::optional<DegenerateForm> best_degenerate_form(const Mat3& first, const Mat3& second) {
  const Mat3 adjugate_of_second = adjugate(second);
  const double leading = second.row(0).dot(adjugate_of_second.col(0));
  if (leading == 0.0) return DegenerateForm{second, adjugate_of_second};
  const Mat3 adjugate_of_first = adjugate(first);
  const RealRoots roots = cubic_roots(first.cwiseProduct(adjugate_of_second).sum() / leading,
                                      adjugate_of_first.cwiseProduct(second).sum() / leading,
                                      first.row(0).dot(adjugate_of_first.col(0)) / leading);
  std::optional<DegenerateForm> best;
  for (std::size_t i = 0; i < roots.count; ++i) {
    const Mat3 form = first + roots.values[i] * second;
    const DegenerateForm candidate{form, adjugate(form)};
    if (!best || candidate.quality() > best->quality()) best = candidate;
  }
  return best->quality() > 0.0 ? best : std::nullopt;
}

/// Normals of the two planes of a degenerate form: with v = p x q / 2 the matrix p q^T is the form (p q^T + q
/// p^T) / 2 plus the antisymmetric matrix of v, up to the sign, which only swaps p and q.
std::array<Vec3, 2> planes_of(const DegenerateForm& degenerate) {
  Eigen::Index k = 0;
  const double squared = -degenerate.adjugate.diagonal().minCoeff(&k);
  const Vec3 v = degenerate.adjugate.col(k) / std::sqrt(squared);
  Mat3 product = degenerate.form;
  product(0, 1) -= v.z();
  product(0, 2) += v.y();
  product(1, 0) += v.z();
  product(1, 2) -= v.x();
  product(2, 0) -= v.y();
  product(2, 1) += v.x();
  Eigen::Index row = 0;
  Eigen::Index column = 0;
  product.cwiseAbs().maxCoeff(&row, &column);
  return {Vec3(product.col(column)), Vec3(product.row(row))};
}

/// Zeros of the form on the plane: up to two directions of the three depths.
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
  discriminant = std::max(discriminant, 0.0);  // double root of a frontal view, split by noise
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

/// Newton's method on Eq. (10). Near a double solution each step halves the distance to it.
std::optional<Vec3> polished(const Triangle& triangle, Vec3 depths) {
  constexpr double rounding = 2e-15;  // of the squared depths
  for (int iteration = 0; iteration < 8; ++iteration) {
    const Vec3 residual = residual_of(triangle, depths);
    if (residual.cwiseAbs().maxCoeff() < rounding * depths.squaredNorm()) break;
    Mat3 jacobian = Mat3::Zero();
    for (Eigen::Index k = 0; k < 3; ++k) {
      const auto [i, j] = pairs[static_cast<std::size_t>(k)];
      jacobian(k, i) = 2.0 * (depths[i] - triangle.cosines[k] * depths[j]);
      jacobian(k, j) = 2.0 * (depths[j] - triangle.cosines[k] * depths[i]);
    }
    const Vec3 step = jacobian.inverse() * residual;
    if (!step.allFinite()) break;
    depths -= step;
  }
  constexpr double tolerance = 1e-6;  // of the squared sides: accepts a double root split by noise
  const bool good =
      depths.allFinite() && (depths.array() > 0.0).all() &&
      residual_of(triangle, depths).cwiseAbs().maxCoeff() < tolerance * triangle.squared_sides.sum();
  return good ? std::optional(depths) : std::nullopt;
}

/// Scales a direction of the depths by the sum of Eq. (10) and refines it.
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

/// Eq. (11): the cosine of the angle between two unit rays, one of alpha, beta and gamma.
double cosine_between(const Vec3& ray, const Vec3& other) {
  return ray.dot(other);
}

Triangle triangle_of(const std::array<Vec3, 3>& rays, const std::array<Vec3, 3>& points) {
  Triangle triangle;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto i = static_cast<std::size_t>(pairs[k].first);
    const auto j = static_cast<std::size_t>(pairs[k].second);
    triangle.cosines[static_cast<Eigen::Index>(k)] = cosine_between(rays[i], rays[j]);
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
  const std::optional<DegenerateForm> degenerate = best_degenerate_form(first, second);
  if (!degenerate) return solutions;
  for (const Vec3& plane : planes_of(*degenerate)) {
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
