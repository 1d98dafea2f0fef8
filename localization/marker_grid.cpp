#include "localization/marker_grid.hpp"

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

/// With q the cell's place in pitches and d the dot's place from the middle in pixels: d = (m + A q) / (1 +
/// w.q). Times the denominator this is linear in m, A and w, solved by normal equations, in which the rows of
/// (m A) share one matrix and only meet in w: eliminating them leaves two equations. w is drawn to zero by a
/// prior that a dot noise of 0.02 pitches and a perspective of 0.02 a pitch (12 cm of marker tilted by 40
/// degrees at 1.3 m) balance.
MarkerGrid MarkerGrid::fitted(std::span<const MarkerDot> dots, const MarkerGrid& start) {
  using Rows = Eigen::Matrix<double, 3, 2>;  // one column for u, one for v; or for the parts of w
  Eigen::Matrix3d places = Eigen::Matrix3d::Zero();
  std::array<Rows, 2> mixed{Rows::Zero(), Rows::Zero()};
  Eigen::Matrix2d perspective = Eigen::Matrix2d::Identity();
  Rows right = Rows::Zero();
  Vec2 perspective_right = Vec2::Zero();
  const double pitch_px = start.pitch_px();
  for (const MarkerDot& dot : dots) {
    const Vec2 q = in_pitches(dot.cell);
    const Vec3 place(1.0, q.x(), q.y());
    const Vec2 d = (dot.center_px - start.middle_px_) / pitch_px;
    places += place * place.transpose();
    mixed[0] -= place * (d.x() * q).transpose();
    mixed[1] -= place * (d.y() * q).transpose();
    perspective += d.squaredNorm() * q * q.transpose();
    right += place * d.transpose();
    perspective_right -= d.squaredNorm() * q;
  }
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

/// Eq. (6)-(8) look from each place R on OY for dots at right angles to it, lambda = 1/3, 2/3 or 1 away.
/// Along OX and OY as they are seen (at right angles only from straight below) both conditions read: the
/// dot's coordinates are whole numbers of pitches.
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
