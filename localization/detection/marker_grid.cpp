#include "localization/detection/marker_grid.hpp"

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <cstddef>

namespace lodestar {
namespace {

constexpr double half_grid = 0.5 * (marker_grid_size - 1);

/// Pitches from the grid's middle towards X and towards Y.
Vec2 in_pitches(GridCell cell) {
  return {cell.column - half_grid, half_grid - cell.row};
}

}  // namespace

MarkerGrid::MarkerGrid(const Vec2& o_px, const Vec2& x_px, const Vec2& y_px)
    : middle_px_(0.5 * (x_px + y_px)) {
  px_from_pitches_ << (x_px - o_px) / (2.0 * half_grid), (y_px - o_px) / (2.0 * half_grid);
}

/// With q the cell's position and d the dot's position from the middle of `start`, both in pitches: d = (m +
/// A q) / (1 + w.q). Times the denominator this is linear in m, A and w. In the normal equations the rows of
/// (m A) share one matrix and couple only through w: eliminating them leaves two equations. A prior pulls w
/// to zero; its weight balances a dot noise of 0.02 pitches and a perspective of 0.02 per pitch (a marker of
/// 12 cm tilted by 40 degrees at 1.3 m).
MarkerGrid MarkerGrid::fitted(std::span<const MarkerDot> dots, const MarkerGrid& start) {
  using Rows = Eigen::Matrix<double, 3, 2>;  // columns: u and v, or the components of w
  // Sums over dots as scalars: each appears in several entries of the symmetric equations.
  const double pitch_px = start.pitch_px();
  const double per_pitch = 1.0 / pitch_px;
  Vec2 q_sum = Vec2::Zero();
  Vec2 d_sum = Vec2::Zero();
  Vec2 far_q_sum = Vec2::Zero();  // times d^2
  Vec3 qq_sum = Vec3::Zero();     // x^2, x y and y^2 of q
  Vec3 far_qq_sum = Vec3::Zero();
  std::array<Vec2, 2> dq_sum{Vec2::Zero(), Vec2::Zero()};
  std::array<Vec3, 2> dqq_sum{Vec3::Zero(), Vec3::Zero()};
  for (const MarkerDot& dot : dots) {
    const Vec2 q = in_pitches(dot.cell);
    const Vec3 qq(q.x() * q.x(), q.x() * q.y(), q.y() * q.y());
    const Vec2 d = (dot.center_px - start.middle_px_) * per_pitch;
    const double far = d.squaredNorm();
    q_sum += q;
    d_sum += d;
    far_q_sum += far * q;
    qq_sum += qq;
    far_qq_sum += far * qq;
    dq_sum[0] += d.x() * q;
    dq_sum[1] += d.y() * q;
    dqq_sum[0] += d.x() * qq;
    dqq_sum[1] += d.y() * qq;
  }
  Eigen::Matrix3d places;
  places << static_cast<double>(dots.size()), q_sum.x(), q_sum.y(), q_sum.x(), qq_sum[0], qq_sum[1],
      q_sum.y(), qq_sum[1], qq_sum[2];
  Rows right;
  right << d_sum.transpose(), dq_sum[0].x(), dq_sum[1].x(), dq_sum[0].y(), dq_sum[1].y();
  std::array<Rows, 2> mixed;
  for (const std::size_t axis : {0U, 1U}) {
    const Vec3& dqq = dqq_sum[axis];
    mixed[axis] << -dq_sum[axis].transpose(), -dqq[0], -dqq[1], -dqq[1], -dqq[2];
  }
  Eigen::Matrix2d perspective;
  perspective << 1.0 + far_qq_sum[0], far_qq_sum[1], far_qq_sum[1], 1.0 + far_qq_sum[2];
  Vec2 perspective_right = -far_q_sum;
  const Eigen::Matrix3d from_places = places.inverse();
  for (Eigen::Index axis : {0, 1}) {
    const Rows& m = mixed[static_cast<std::size_t>(axis)];
    perspective -= m.transpose() * from_places * m;
    perspective_right -= m.transpose() * from_places * right.col(axis);
  }
  const Vec2 w = perspective.inverse() * perspective_right;
  const Vec3 u = from_places * (right.col(0) - mixed[0] * w);
  const Vec3 v = from_places * (right.col(1) - mixed[1] * w);
  MarkerGrid grid = start;
  grid.middle_px_ += pitch_px * Vec2(u[0], v[0]);
  grid.px_from_pitches_ << u[1], u[2], v[1], v[2];
  grid.px_from_pitches_ *= pitch_px;
  // (m + A q) / (1 + w.q) = m + (A - m w^T) q / (1 + w.q)
  grid.perspective_ = w;
  grid.px_from_pitches_ -= (grid.middle_px_ - start.middle_px_) * grid.perspective_.transpose();
  return grid;
}

Vec2 MarkerGrid::center_px(GridCell cell) const {
  const Vec2 q = in_pitches(cell);
  return middle_px_ + px_from_pitches_ * q / (1.0 + perspective_.dot(q));
}

/// Eq. (6)-(8) search from each place R on OY for dots at right angles to it, at lambda = 1/3, 2/3 or 1.
/// Along OX and OY as imaged (at right angles only from straight below) both conditions read: the dot's
/// coordinates are whole numbers of pitches.
std::optional<GridCell> MarkerGrid::cell_at(const Vec2& dot_px, double tolerance) const {
  const Vec2 q = px_from_pitches_.inverse() * (dot_px - middle_px_);
  const Vec2 place(q.x() + half_grid, half_grid - q.y());  // column, row
  const Vec2 whole(std::round(place.x()), std::round(place.y()));
  const bool in_grid = whole.minCoeff() >= 0.0 && whole.maxCoeff() <= marker_grid_size - 1;
  if (!in_grid || (place - whole).norm() > tolerance) return std::nullopt;
  return GridCell{.row = static_cast<int>(whole.y()), .column = static_cast<int>(whole.x())};
}

double MarkerGrid::pitch_px() const {
  return std::sqrt(std::abs(px_from_pitches_.determinant()));
}

}  // namespace lodestar
