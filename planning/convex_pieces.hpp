#pragma once

#include <vector>

#include "maps/geometry.hpp"
#include "maps/occupancy_map.hpp"

// Polygons as lists of corners, counter-clockwise, in any one unit.
namespace lodestar {

using Polygon = std::vector<Vec2>;

/// Corners of the convex hull (Andrew 1979).
Polygon hull_of(std::vector<Vec2> points);

/// A simple polygon cut into convex ones: itself when it is convex, else triangles (ear clipping, Meisters
/// 1975).
std::vector<Polygon> convex_pieces(const Polygon& polygon);

/// Does the polygon go around once, counter-clockwise, without touching or crossing itself?
bool is_simple(const Polygon& polygon);

/// Does a convex polygon overlap the unit square of a cell? Touching is no overlap.
bool overlaps(const Polygon& convex, Cell cell);

/// Does a convex polygon that turns about a point, from where it is by an angle of either sign, ever overlap
/// the square of a cell? Exact: whether two convex shapes overlap changes only at angles at which a corner of
/// one crosses the line of an edge of the other; between these one look is enough.
bool overlaps_turning(const Polygon& convex, const Vec2& about, double turn_rad, Cell cell);

}  // namespace lodestar
