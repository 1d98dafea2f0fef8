#include "localization/detection/marker_decoder.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace lodestar {
namespace {

std::pair<std::size_t, std::size_t> farthest_pair(std::span<const Dot> dots) {
  std::pair<std::size_t, std::size_t> best;
  double longest = -1.0;
  for (std::size_t a = 0; a < dots.size(); ++a) {
    for (std::size_t b = a + 1; b < dots.size(); ++b) {
      const double distance = (dots[a].center_px - dots[b].center_px).squaredNorm();
      if (distance > longest) {
        longest = distance;
        best = {a, b};
      }
    }
  }
  return best;
}

/// Eq. (4) and (5) with the rotation's sign corrected: turning OX a quarter clockwise takes it away from OY.
/// The printed face shows Y a quarter turn counter-clockwise of X, which in an image with v down is a
/// negative cross product.
DirectionDots with_axes_named(std::span<const Dot> dots, std::size_t o, std::size_t a, std::size_t b) {
  const Vec2 oa = dots[a].center_px - dots[o].center_px;
  const Vec2 ob = dots[b].center_px - dots[o].center_px;
  return cross(oa, ob) < 0.0 ? DirectionDots{o, a, b} : DirectionDots{o, b, a};
}

/// True when these three may be the corners of a tilted square of the size that their dots imply. An L of
/// other dots (2 by 2 or 2 by 3 pitches, or oblique) has too long a side or a pitch too small for its dots.
bool spans_a_grid(std::span<const Dot> dots, const DirectionDots& direction,
                  const MarkerDecoderOptions& options) {
  const bool few = dots.size() < options.least_dots_for_tilt;
  const Vec2 ox = dots[direction.x].center_px - dots[direction.o].center_px;
  const Vec2 oy = dots[direction.y].center_px - dots[direction.o].center_px;
  const double area = -cross(ox, oy);
  if (!(area > 0.0)) return false;
  // Singular values s >= t of the columns OX, OY: s t = area, s^2 + t^2 = |OX|^2 + |OY|^2. A tilt makes t / s
  // its cosine c, so (s^2 + t^2) / (s t) = c + 1 / c.
  const double least_cosine = std::cos(few ? options.most_tilt_of_few_rad : options.most_tilt_rad);
  if (ox.squaredNorm() + oy.squaredNorm() > (least_cosine + 1.0 / least_cosine) * area) return false;
  const double radius_px =
      (dots[direction.o].radius_px + dots[direction.x].radius_px + dots[direction.y].radius_px) / 3.0;
  const double wanted_px = std::sqrt(area) / (marker_grid_size - 1) / radii_per_pitch;
  const double tolerance = 1.0 + options.size_tolerance;
  const double growth_px = few ? options.growth_of_few_px : options.growth_px;
  return radius_px <= (tolerance + growth_px / radius_px) * wanted_px &&
         wanted_px <= (tolerance + options.small_dot_tolerance_px / radius_px) * radius_px;
}

bool sizes_are_alike(std::span<const Dot> dots, const MarkerDecoderOptions& options) {
  const auto [small, large] = std::ranges::minmax(dots, {}, &Dot::radius_px);
  const bool structure = std::ranges::any_of(dots, &Dot::on_structure);
  return large.radius_px - small.radius_px <=
         (structure ? options.alike_on_structure : options.alike_tolerance) * small.radius_px +
             options.alike_tolerance_px2 / small.radius_px;
}

/// One cell for each dot; nothing when a dot is in no cell, in another dot's, or in the corner that is always
/// empty.
MarkerDots dots_in_cells(std::span<const Dot> dots, const MarkerGrid& grid, double tolerance) {
  std::array<bool, marker_grid_size * marker_grid_size> taken{};
  MarkerDots result;
  for (const Dot& dot : dots) {
    const std::optional<GridCell> cell = grid.cell_at(dot.center_px, tolerance);
    if (!cell || *cell == cell_always_empty) return {};
    bool& cell_taken = taken[static_cast<std::size_t>(cell->row * marker_grid_size + cell->column)];
    if (cell_taken) return {};
    cell_taken = true;
    result.push_back({*cell, dot.center_px, dot.sigma_px});
  }
  return result;
}

bool fits(const MarkerGrid& grid, std::span<const MarkerDot> dots, double tolerance_px) {
  return std::ranges::all_of(dots, [&](const MarkerDot& dot) {
    return (grid.center_px(dot.cell) - dot.center_px).norm() <= tolerance_px;
  });
}

/// Dots of the square that the direction dots span, with a margin that must be clear around it; none when
/// they are too many for one marker.
MarkerDotIndices dots_about(std::span<const Dot> dots, const DirectionDots& direction, double guard) {
  const Vec2 o = dots[direction.o].center_px;
  Eigen::Matrix2d px_from_pitches;
  px_from_pitches << dots[direction.x].center_px - o, dots[direction.y].center_px - o;
  px_from_pitches /= marker_grid_size - 1;
  const Eigen::Matrix2d pitches_from_px = px_from_pitches.inverse();
  MarkerDotIndices indices;
  for (std::size_t i = 0; i < dots.size(); ++i) {
    const Vec2 q = pitches_from_px * (dots[i].center_px - o);
    if (!(q.minCoeff() > -guard && q.maxCoeff() < marker_grid_size - 1 + guard)) continue;
    if (indices.size() == indices.capacity()) return {};
    indices.push_back(i);
  }
  return indices;
}

/// Reads the marker that has these three as direction dots.
std::optional<MarkerReading> read_marker_among(std::span<const Dot> dots, const DirectionDots& direction,
                                               const MarkerDecoderOptions& options) {
  if (!spans_a_grid(dots, direction, options)) return std::nullopt;
  const MarkerDotIndices indices = dots_about(dots, direction, options.guard_pitches);
  if (indices.size() < options.least_dots_in_a_crowd) return std::nullopt;
  InlineVector<Dot, MarkerDotIndices::static_capacity> members;
  for (const std::size_t i : indices) members.push_back(dots[i]);
  const auto among_members = [&](std::size_t i) {
    return static_cast<std::size_t>(std::ranges::lower_bound(indices, i) - indices.begin());
  };
  const DirectionDots own{among_members(direction.o), among_members(direction.x), among_members(direction.y)};
  std::optional<MarkerReading> reading = read_marker(members, own, options);
  if (reading) reading->indices = indices;
  return reading;
}

bool share_a_dot(const MarkerReading& a, const MarkerReading& b) {
  return std::ranges::find_first_of(a.indices, b.indices) != a.indices.end();
}

/// True when these two may be the ends of an axis, by the dots' size. Tilt shortens an axis more than it
/// narrows dots.
bool may_span_an_axis(const Dot& a, const Dot& b) {
  const double pitches = (a.center_px - b.center_px).norm() / (radii_per_pitch * a.radius_px);
  return std::abs(pitches - (marker_grid_size - 1)) < 1.5;
}

}  // namespace

std::optional<DirectionDots> direction_dots(std::span<const Dot> dots) {
  if (dots.size() < 3) return std::nullopt;
  const auto [a, b] = farthest_pair(dots);
  const Vec2 middle = 0.5 * (dots[a].center_px + dots[b].center_px);
  std::size_t o = dots.size();
  double longest = -1.0;
  for (std::size_t i = 0; i < dots.size(); ++i) {
    const double distance = (dots[i].center_px - middle).squaredNorm();
    if (i == a || i == b || distance <= longest) continue;
    longest = distance;
    o = i;
  }
  return with_axes_named(dots, o, a, b);
}

int id_of(std::span<const MarkerDot> dots) {
  int id = 0;
  for (const MarkerDot& dot : dots) id += id_bit(dot.cell);  // (9): W is 1 where a coded dot may be
  return id;
}

std::optional<MarkerReading> read_marker(std::span<const Dot> dots, const DirectionDots& direction,
                                         const MarkerDecoderOptions& options) {
  if (!spans_a_grid(dots, direction, options) || !sizes_are_alike(dots, options)) {
    return std::nullopt;
  }
  const MarkerGrid through_direction_dots(dots[direction.o].center_px, dots[direction.x].center_px,
                                          dots[direction.y].center_px);
  const MarkerDots in_cells = dots_in_cells(dots, through_direction_dots, options.cell_tolerance);
  if (in_cells.empty()) return std::nullopt;
  const MarkerGrid grid = MarkerGrid::fitted(in_cells, through_direction_dots);
  if (!fits(grid, in_cells, options.fit_tolerance * grid.pitch_px())) return std::nullopt;
  MarkerDotIndices indices;
  for (std::size_t i = 0; i < in_cells.size(); ++i) indices.push_back(i);
  return MarkerReading{id_of(in_cells), grid, in_cells, indices};
}

std::span<const MarkerReading> AreaReader::read(std::span<const Dot> dots) {
  readings_.clear();
  if (dots.size() < 3 || dots.size() > options_.most_dots) return {};
  if (const auto direction = direction_dots(dots)) {
    if (const std::optional<MarkerReading> reading = read_marker(dots, *direction, options_)) {
      readings_.push_back(*reading);
      return readings_;
    }
  }
  if (!options_.every_corner) return {};
  read_every_corner(dots);
  reject_conflicts();
  if (!readings_.empty()) read_the_rest(dots);
  return readings_;
}

void AreaReader::read_every_corner(std::span<const Dot> dots) {
  tried_.clear();
  for (std::size_t o = 0; o < dots.size(); ++o) {
    ends_.clear();
    for (std::size_t i = 0; i < dots.size(); ++i) {
      if (i != o && may_span_an_axis(dots[o], dots[i])) ends_.push_back(i);
    }
    for (const std::size_t x : ends_) {
      for (const std::size_t y : ends_) {
        const std::optional<MarkerReading> reading = read_marker_among(dots, {o, x, y}, options_);
        if (reading) tried_.push_back(*reading);
      }
    }
  }
}

void AreaReader::reject_conflicts() {
  for (const MarkerReading& reading : tried_) {
    const auto conflicts = [&](const MarkerReading& other) {
      return &other != &reading && share_a_dot(reading, other);
    };
    if (std::ranges::none_of(tried_, conflicts)) readings_.push_back(reading);
  }
}

/// The dots left by the other readings may be one more marker, with too few dots for a crowded area.
void AreaReader::read_the_rest(std::span<const Dot> dots) {
  rest_.clear();
  rest_indices_.clear();
  for (std::size_t i = 0; i < dots.size(); ++i) {
    const bool is_taken = std::ranges::any_of(readings_, [i](const MarkerReading& reading) {
      return std::ranges::find(reading.indices, i) != reading.indices.end();
    });
    if (is_taken) continue;
    rest_.push_back(dots[i]);
    rest_indices_.push_back(i);
  }
  const std::optional<DirectionDots> direction = direction_dots(rest_);
  std::optional<MarkerReading> reading = direction ? read_marker(rest_, *direction, options_) : std::nullopt;
  if (!reading) return;
  for (std::size_t& index : reading->indices) index = rest_indices_[index];
  readings_.push_back(*reading);
}

}  // namespace lodestar
