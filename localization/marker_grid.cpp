#include "localization/marker_grid.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

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
/// w.q). Times the denominator this is linear in m, A and w, solved by normal equations. w is drawn to zero
/// by a prior that a dot noise of 0.02 pitches and a perspective of 0.02 a pitch (12 cm of marker tilted by
/// 40 degrees at 1.3 m) balance.
MarkerGrid MarkerGrid::fitted(std::span<const MarkerDot> dots, const MarkerGrid& start) {
  using Row = Eigen::Matrix<double, 8, 1>;
  Eigen::Matrix<double, 8, 8> normal = Eigen::Matrix<double, 8, 8>::Zero();
  Row right = Row::Zero();
  const double pitch_px = start.pitch_px();
  for (const MarkerDot& dot : dots) {
    const Vec2 q = in_pitches(dot.cell);
    const Vec2 d = (dot.center_px - start.middle_px_) / pitch_px;
    Row row_u, row_v;
    row_u << 1.0, q.x(), q.y(), 0.0, 0.0, 0.0, -q.x() * d.x(), -q.y() * d.x();
    row_v << 0.0, 0.0, 0.0, 1.0, q.x(), q.y(), -q.x() * d.y(), -q.y() * d.y();
    normal += row_u * row_u.transpose() + row_v * row_v.transpose();
    right += row_u * d.x() + row_v * d.y();
  }
  normal.diagonal().tail<2>().array() += 1.0;
  const Row s = normal.ldlt().solve(right);
  MarkerGrid grid = start;
  grid.middle_px_ += pitch_px * Vec2(s[0], s[3]);
  grid.px_from_pitches_ << s[1], s[2], s[4], s[5];
  grid.px_from_pitches_ *= pitch_px;
  // (m + A q) / (1 + w.q) = m + (A - m w^T) q / (1 + w.q)
  grid.perspective_ = s.tail<2>();
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
