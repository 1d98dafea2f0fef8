#pragma once

#include <vector>

#include "maps/geometry.hpp"
#include "maps/occupancy_map.hpp"

// Polygons as lists of corners, counter-clockwise, in any unit.
namespace lodestar {

using Polygon = std::vector<Vec2>;

/// Corners of the convex hull (Andrew 1979).
Polygon hull_of(std::vector<Vec2> points);

/// A simple polygon cut into convex ones: itself when it is convex, else triangles (ear clipping, Meisters
/// 1975).
std::vector<Polygon> convex_pieces(const Polygon& polygon);

/// Is the polygon counter-clockwise, without touching or crossing itself?
bool is_simple(const Polygon& polygon);

/// Does a convex polygon overlap the unit square of a cell? Touching is no overlap.
bool overlaps(const Polygon& convex, Cell cell);

/// Does a convex polygon overlap the square of a cell at any time while it turns about a point by an angle of
/// either sign? Exact: overlap of two convex shapes changes only at angles at which a corner of one crosses
/// the line of an edge of the other; between two such angles one check is enough.
bool overlaps_turning(const Polygon& convex, const Vec2& about, double turn_rad, Cell cell);

}  // namespace lodestar
