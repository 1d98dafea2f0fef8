#include "localization/detection/marker_lattice.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "maps/marker.hpp"

namespace lodestar {
namespace {

struct Basis {
  Vec2 origin_px;
  Eigen::Matrix2d px_from_places;  ///< columns: one place to the right, one down
};

/// The square lattice on which these two dots are `places` apart in a row.
Basis square_basis(const Dot& a, const Dot& b, int places) {
  const Vec2 right = (b.center_px - a.center_px) / places;
  Basis basis{.origin_px = a.center_px, .px_from_places = {}};
  basis.px_from_places << right.x(), -right.y(), right.y(), right.x();
  return basis;
}

/// Dots near an integer place, the nearest dot for each place.
LatticeDots dots_on(std::span<const Dot> dots, const Basis& basis, double tolerance) {
  const Eigen::Matrix2d places_from_px = basis.px_from_places.inverse();
  struct Taken {
    LatticeDot dot;
    double distance = 0.0;
  };
  InlineVector<Taken, LatticeDots::static_capacity> taken;
  for (std::size_t i = 0; i < dots.size(); ++i) {
    const Vec2 place = places_from_px * (dots[i].center_px - basis.origin_px);
    const Vec2 whole(std::round(place.x()), std::round(place.y()));
    const double distance = (place - whole).norm();
    if (distance > tolerance || whole.cwiseAbs().maxCoeff() > 2 * marker_grid_size) continue;
    const LatticeDot dot{i, static_cast<int>(whole.x()), static_cast<int>(whole.y())};
    const auto same = std::ranges::find_if(taken, [&](const Taken& other) {
      return other.dot.column == dot.column && other.dot.row == dot.row;
    });
    if (same == taken.end()) {
      taken.push_back({dot, distance});
    } else if (distance < same->distance) {
      *same = {dot, distance};
    }
  }
  LatticeDots result;
  for (const Taken& t : taken) result.push_back(t.dot);
  return result;
}

bool is_inside(const LatticeDot& dot, int left, int top) {
  return dot.column >= left && dot.column < left + marker_grid_size && dot.row >= top &&
         dot.row < top + marker_grid_size;
}

/// The dots in the square of four by four places that holds most of them.
LatticeDots in_best_square(const LatticeDots& dots) {
  std::ptrdiff_t most = 0;
  int best_left = 0;
  int best_top = 0;
  for (const LatticeDot& left : dots) {
    for (const LatticeDot& top : dots) {
      const auto count = std::ranges::count_if(
          dots, [&](const LatticeDot& dot) { return is_inside(dot, left.column, top.row); });
      if (count <= most) continue;
      most = count;
      best_left = left.column;
      best_top = top.row;
    }
  }
  LatticeDots inside;
  for (const LatticeDot& dot : dots)
    if (is_inside(dot, best_left, best_top)) inside.push_back(dot);
  return inside;
}

/// Least-squares affine lattice of the dots. Nothing for collinear dots.
std::optional<Basis> fitted(std::span<const Dot> dots, const LatticeDots& on) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 3, 2> right = Eigen::Matrix<double, 3, 2>::Zero();
  for (const LatticeDot& dot : on) {
    const Vec3 row(1.0, dot.column, dot.row);
    normal += row * row.transpose();
    right += row * dots[dot.index].center_px.transpose();
  }
  const Eigen::FullPivLU<Eigen::Matrix3d> factors(normal);
  if (!factors.isInvertible()) return std::nullopt;
  const Eigen::Matrix<double, 3, 2> solution = factors.solve(right);
  Basis basis{.origin_px = solution.row(0).transpose(), .px_from_places = {}};
  basis.px_from_places << solution.row(1).transpose(), solution.row(2).transpose();
  return basis;
}

double mean_radius_px(std::span<const Dot> dots, const LatticeDots& on) {
  double sum = 0.0;
  for (const LatticeDot& dot : on) sum += dots[dot.index].radius_px;
  return sum / static_cast<double>(on.size());
}

/// True for a tilted square of the pitch that the dots' size implies.
bool is_plausible(const Basis& basis, double radius_px, const LatticeOptions& options) {
  const double area = basis.px_from_places.determinant();
  if (!(area > 0.0)) return false;
  const double cosine = options.least_cosine;
  if (basis.px_from_places.squaredNorm() > (cosine + 1.0 / cosine) * area) return false;
  const double ratio = std::sqrt(area) / (radii_per_pitch * radius_px);
  return ratio > 1.0 / (1.0 + options.size_tolerance) && ratio < 1.0 + options.size_tolerance;
}

std::optional<DotLattice> lattice_from(std::span<const Dot> dots, const Basis& start,
                                       const LatticeOptions& options) {
  LatticeDots on = in_best_square(dots_on(dots, start, options.first_tolerance));
  if (on.size() < options.least_dots) return std::nullopt;
  std::optional<Basis> basis = fitted(dots, on);
  if (!basis) return std::nullopt;
  on = in_best_square(dots_on(dots, *basis, options.tolerance));
  if (on.size() < options.least_dots) return std::nullopt;
  basis = fitted(dots, on);
  if (!basis || !is_plausible(*basis, mean_radius_px(dots, on), options)) return std::nullopt;
  return DotLattice{.origin_px = basis->origin_px,
                    .column_px = basis->px_from_places.col(0),
                    .row_px = basis->px_from_places.col(1),
                    .dots = on};
}

}  // namespace

std::optional<DotLattice> find_lattice(std::span<const Dot> dots, const LatticeOptions& options) {
  if (dots.size() < options.least_dots ||
      dots.size() > std::min(options.most_dots, std::size_t{LatticeDots::static_capacity}))
    return std::nullopt;
  std::optional<DotLattice> best;
  for (std::size_t a = 0; a < dots.size(); ++a) {
    for (std::size_t b = a + 1; b < dots.size(); ++b) {
      const double pitch_px = 0.5 * radii_per_pitch * (dots[a].radius_px + dots[b].radius_px);
      const double pitches = (dots[b].center_px - dots[a].center_px).norm() / pitch_px;
      const int places = static_cast<int>(std::lround(pitches));
      if (places < 1 || places >= marker_grid_size ||
          std::abs(pitches - places) > options.size_tolerance * places) {
        continue;
      }
      const std::optional<DotLattice> lattice =
          lattice_from(dots, square_basis(dots[a], dots[b], places), options);
      if (!lattice || (best && lattice->dots.size() <= best->dots.size())) continue;
      best = lattice;
      if (best->dots.size() == dots.size()) return best;
    }
  }
  return best;
}

}  // namespace lodestar
